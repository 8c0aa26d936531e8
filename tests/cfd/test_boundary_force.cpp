// SPDX-FileCopyrightText: 2026 The GranFlux developers
// SPDX-License-Identifier: BSD-3-Clause

// Force of the gas on one boundary, against closed forms.
#include <gtest/gtest.h>

#include <granflux/cfd/annulus_grid.hpp>
#include <granflux/cfd/error.hpp>
#include <granflux/cfd/join_blocks.hpp>
#include <granflux/cfd/split_blocks.hpp>

#include "box_case.hpp"

using namespace granflux;
using namespace granflux::cfd;
using namespace granflux::cfd::testing;

namespace {

Mesh dealt(const Grid& grid) {
  int ranks = 1;
  MPI_Comm_size(MPI_COMM_WORLD, &ranks);
  return make_mesh(split_for_ranks(grid, ranks), MPI_COMM_WORLD);
}

void run(GasSolver& gas, double dt, int steps) {
  for (int s = 0; s < steps; ++s)
    gas.advance(dt, make_fields(gas.mesh(), 1), nullptr);
}

TEST(BoundaryForce, WallsOfAChannelBearItsPressureDrop) {
  constexpr double gradient = 0.4, speed = 0.7, mu = 0.1, area = 2 * 0.5;
  GasCase c = box_case({2, 12, 2}, {2, 1, 0.5}, {true, false, true}, {1, 2, 1});
  c.fluid.viscosity = mu;
  c.fluid.driving_pressure_gradient = {-gradient, 0, 0};
  boundary(c, "y_high").velocity = {speed, 0, 0};
  const Mesh mesh = make_mesh(c, MPI_COMM_WORLD);
  GasSolver gas(mesh, c);
  run(gas, 0.1, 400);
  EXPECT_NEAR(gas.boundary_force("y_low").x, area * (0.5 * gradient + mu * speed), 1e-9);
  EXPECT_NEAR(gas.boundary_force("y_high").x, area * (0.5 * gradient - mu * speed), 1e-9);
  EXPECT_THROW((void)gas.boundary_force("y_lo"), ConfigError);
}

/// Box of height and length 1 that leans by 0.4 along x, floor and lid being walls; open to itself
/// along x or closed by walls.
constexpr double lid_speed = 0.7, viscosity = 0.1, depth = 0.25;

GasCase leaning_case(bool closed) {
  GasCase c;
  c.fluid.density = 1;
  c.fluid.viscosity = viscosity;
  for (const char* name : {"floor", "lid", "left", "right"}) {
    if (!closed && c.boundaries.size() == 2)
      break;
    BoundaryCondition wall;
    wall.name = name;
    if (wall.name == "lid")
      wall.velocity = {lid_speed, 0, 0};
    c.boundaries.push_back(wall);
  }
  c.numerics.convection = ConvectionScheme::central;
  return c;
}

Mesh leaning_mesh(const GasCase& c, int n) {
  Grid grid;
  grid.blocks.push_back({"leaning",
                         {n, n, 2},
                         [n](int i, int j, int k) {
                           return Vec3{double(i) / n + 0.4 * j / n, double(j) / n, depth * k / 2};
                         },
                         {}});
  join_sides(grid, 0, {2, true}, 0, {1, 2, 3}, {0, 0, depth});
  if (c.boundaries.size() == 2)
    join_sides(grid, 0, {0, true}, 0, {1, 2, 3}, {1, 0, 0});
  constexpr Side sides[] = {{1, false}, {1, true}, {0, false}, {0, true}};
  for (std::size_t b = 0; b < c.boundaries.size(); ++b) {
    grid.blocks[0].patches.push_back(boundary_side(grid.blocks[0].cells, sides[b], int(b)));
    grid.boundaries.push_back(c.boundaries[b].name);
  }
  return dealt(grid);
}

TEST(BoundaryForce, LeaningCellsBetweenPlatesAreExact) {
  const GasCase c = leaning_case(false);
  const Mesh mesh = leaning_mesh(c, 6);
  ASSERT_FALSE(mesh.orthogonal);
  GasSolver gas(mesh, c);
  run(gas, 0.1, 400);
  EXPECT_LT(norm(gas.boundary_force("floor") - Vec3{viscosity * lid_speed * depth, 0, 0}), 1e-9);
  EXPECT_LT(norm(gas.boundary_force("lid") + Vec3{viscosity * lid_speed * depth, 0, 0}), 1e-9);
}

TEST(BoundaryForce, AllWallsTogetherBearWhatTheMomentumBudgetSays) {
  const GasCase c = leaning_case(true);
  const Mesh mesh = leaning_mesh(c, 8);
  GasSolver gas(mesh, c);
  run(gas, 0.05, 400); // the budget is of the middle of a step: steady
  Vec3 all;
  double scale = 0;
  for (const BoundaryCondition& wall : c.boundaries) {
    const Vec3 force = gas.boundary_force(wall.name);
    all += force, scale += norm(force);
  }
  EXPECT_LT(norm(all + gas.balance().friction + gas.balance().pressure), 1e-9 * scale);
}

/// Rigid rotation, which is linear in x, on a ring whose rays are spirals: all parts of the stress
/// together are nothing, on each half of the outer wall.
TEST(BoundaryForce, GasThatTurnsWithItsWallsDoesNotRubOnThem) {
  constexpr double outer = 2, length = 0.3, turning = 1.5;
  AnnulusGrid annulus;
  annulus.inner_radius = 1, annulus.outer_radius = outer, annulus.length = length;
  annulus.radial = 5, annulus.tangential = 24, annulus.axial = 1;
  annulus.periodic_axis = true;
  annulus.arcs = {{"upper", 0, 180}, {"lower", 180, 360}};
  Grid grid = make_annulus(annulus);
  grid.blocks[0].node = [ring = grid.blocks[0].node](int i, int j, int k) {
    const Vec3 x = ring(i, j, k);
    const double angle = 0.4 * std::hypot(x.x, x.y), c = std::cos(angle), s = std::sin(angle);
    return Vec3{c * x.x - s * x.y, s * x.x + c * x.y, x.z};
  };
  const Mesh mesh = dealt(grid);
  GasCase c;
  c.fluid.density = 1;
  c.fluid.viscosity = viscosity;
  for (const char* name : {"inner", "upper", "lower"}) {
    BoundaryCondition wall;
    wall.name = name;
    wall.angular_velocity = {0, 0, turning};
    c.boundaries.push_back(wall);
  }
  GasSolver gas(mesh, c);
  BlockVectors velocity = make_vectors(mesh);
  for_each_cell(mesh, [&](std::size_t b, std::ptrdiff_t p, const Vec3& x) {
    velocity[b][0][p] = -turning * x.y, velocity[b][1][p] = turning * x.x;
  });
  gas.initialise(make_fields(mesh, 1), velocity); // no pressure yet
  for (const char* half : {"upper", "lower"})
    EXPECT_LT(norm(gas.boundary_force(half)), 1e-10 * viscosity * turning * outer * length);
}

/// Gap between a cylinder of radius 1 at rest and one of radius 2 that turns at 1 rad/s:
/// u = A r + B / r. Relative error of the friction on half of the outer one, which the transposed
/// part of the stress has a share of: across the half's axis of symmetry only the friction pulls.
double half_shell_error(int n) {
  constexpr double mu = 1, length = 0.3, outer = 2, a = 4. / 3, b = -4. / 3;
  AnnulusGrid annulus;
  annulus.inner_radius = 1, annulus.outer_radius = outer, annulus.length = length;
  annulus.radial = n, annulus.tangential = 6 * n, annulus.axial = 1;
  annulus.periodic_axis = true;
  annulus.arcs = {{"upper", 0, 180}, {"lower", 180, 360}};
  const Mesh mesh = dealt(make_annulus(annulus));
  GasCase c;
  c.fluid.density = 1;
  c.fluid.viscosity = mu;
  BoundaryCondition wall;
  wall.name = "inner";
  c.boundaries.push_back(wall);
  for (const char* name : {"upper", "lower"}) {
    wall.name = name;
    wall.angular_velocity = {0, 0, 1};
    c.boundaries.push_back(wall);
  }
  c.numerics.convection = ConvectionScheme::central;
  c.numerics.pressure_tolerance = 1e-8;
  GasSolver gas(mesh, c);
  run(gas, 0.02, 80);                                  // slowest mode: e^(-10 t)
  EXPECT_NEAR(a * outer + b / outer, outer, 1e-12);    // closed form meets the wall
  const double stress = -2 * mu * b / (outer * outer); // mu r d(u/r)/dr on the gas
  const double pull = 2 * stress * outer * length;     // of the gas on the upper half, along x
  const Vec3 upper = gas.boundary_force("upper"), lower = gas.boundary_force("lower");
  EXPECT_LT(norm(upper + lower), 1e-6 * norm(upper));
  return upper.x / pull - 1;
}

TEST(BoundaryForce, HalfOfATurningShellIsSecondOrder) {
  const double coarse = half_shell_error(8), fine = half_shell_error(16);
  EXPECT_LT(std::abs(fine), 2e-3);
  EXPECT_GT(std::log2(coarse / fine), 1.9);
}

} // namespace
