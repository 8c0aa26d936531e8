// SPDX-FileCopyrightText: 2026 The GranFlux developers
// SPDX-License-Identifier: BSD-3-Clause

// Meshes whose cells are neither square nor turned alike from block to block.
#include <gtest/gtest.h>

#include <granflux/cfd/annulus_grid.hpp>
#include <granflux/cfd/cylinder_grid.hpp>
#include <granflux/cfd/split_blocks.hpp>

#include "box_case.hpp"
#include "skewed_square.hpp"

using namespace granflux;
using namespace granflux::cfd;
using namespace granflux::cfd::testing;

namespace {

Mesh dealt(const Grid& grid) {
  int ranks = 1;
  MPI_Comm_size(MPI_COMM_WORLD, &ranks);
  return make_mesh(split_for_ranks(grid, ranks), MPI_COMM_WORLD);
}

BoundaryCondition condition(const std::string& name, BoundaryKind kind, Vec3 velocity = {}) {
  BoundaryCondition c;
  c.name = name;
  c.kind = kind;
  c.velocity = velocity;
  return c;
}

CylinderGrid drum_grid() {
  CylinderGrid cylinder;
  cylinder.radius = 0.5, cylinder.length = 1;
  cylinder.core = 4, cylinder.radial = 3, cylinder.axial = 6, cylinder.axial_blocks = 2;
  return cylinder;
}

AnnulusGrid gap_grid() {
  AnnulusGrid annulus;
  annulus.inner_radius = 0.3, annulus.outer_radius = 0.7, annulus.length = 1;
  annulus.radial = 4, annulus.tangential = 12, annulus.axial = 3, annulus.growth = 1.3;
  return annulus;
}

/// How far a uniform flow is from uniform after some steps, with both time schemes.
double unevenness(const Mesh& mesh, GasCase c, const Vec3& flow) {
  double worst = 0;
  c.fluid.density = 1;
  c.fluid.viscosity = 0.05;
  c.initial_velocity = flow;
  for (const TimeScheme scheme : {TimeScheme::semi_implicit, TimeScheme::implicit})
    for (const auto convection :
         {ConvectionScheme::central, ConvectionScheme::upwind2, ConvectionScheme::limited}) {
      c.numerics.time_scheme = scheme;
      c.numerics.convection = convection;
      GasSolver gas(mesh, c);
      gas.initialise(make_fields(mesh, 1), flow);
      for (int s = 0; s < 5; ++s)
        gas.advance(0.02, make_fields(mesh, 1), nullptr);
      worst = std::max(worst, largest(mesh, [&](std::size_t b, std::ptrdiff_t p, const Vec3&) {
                         const VectorField& u = gas.velocity()[b];
                         return norm(Vec3{u[0][p], u[1][p], u[2][p]} - flow);
                       }));
    }
  return worst;
}

TEST(SkewedMesh, UniformFlowStaysUniform) {
  const Mesh square = dealt(skewed_square(6, 1.0, 2));
  EXPECT_FALSE(square.orthogonal);
  EXPECT_LT(unevenness(square, {}, {0.7, -0.4, 0.2}), 1e-12);

  GasCase c;
  c.boundaries = {condition("wall", BoundaryKind::slip),
                  condition("low", BoundaryKind::inlet, {0, 0, 0.8}),
                  condition("high", BoundaryKind::outlet)};
  const Mesh drum = dealt(make_cylinder(drum_grid()));
  EXPECT_LT(unevenness(drum, c, {0, 0, 0.8}), 1e-12);

  c.boundaries = {condition("inner", BoundaryKind::slip), condition("outer", BoundaryKind::slip)};
  AnnulusGrid annulus = gap_grid();
  annulus.periodic_axis = true;
  const Mesh gap = dealt(make_annulus(annulus));
  EXPECT_LT(unevenness(gap, c, {0, 0, 0.8}), 1e-12);
}

/// Aslant through every boundary: in on all sides but one, where the pressure is given.
TEST(SkewedMesh, UniformFlowAslantStaysUniform) {
  constexpr Vec3 flow{0.5, -0.3, 0.8};
  const auto unevenness_of = [&](const Mesh& mesh) {
    GasCase c;
    for (const std::string& name : mesh.boundaries)
      c.boundaries.push_back(
          condition(name, name == "high" ? BoundaryKind::outlet : BoundaryKind::inlet, flow));
    return unevenness(mesh, c, flow);
  };
  EXPECT_LT(unevenness_of(dealt(make_cylinder(drum_grid()))), 1e-12);
  EXPECT_LT(unevenness_of(dealt(make_annulus(gap_grid()))), 1e-12);
  AnnulusGrid drawn = gap_grid(); // nodes one by one
  drawn.radii = {0.3, 0.34, 0.45, 0.5, 0.7};
  drawn.angles = {-180, -150, -90, -50, -20, -10, 0, 10, 20, 60, 95, 130, 180};
  EXPECT_LT(unevenness_of(dealt(make_annulus(drawn))), 1e-12);
}

TEST(SkewedMesh, UniformFlowStaysUniformOnABoxOfUnequalCells) {
  GasCase c = box_case({5, 4, 6}, {1, 1, 1}, {false, true, false});
  box_grid(c).nodes[0] = {0, 0.1, 0.15, 0.5, 0.8, 1};
  box_grid(c).nodes[2] = {0, 0.3, 0.35, 0.4, 0.7, 0.95, 1};
  constexpr Vec3 flow{0.5, -0.3, 0.8};
  for (BoundaryCondition& b : c.boundaries) {
    b.kind = b.name == "z_high" ? BoundaryKind::outlet : BoundaryKind::inlet;
    b.velocity = flow;
  }
  const Mesh mesh = make_mesh(c, MPI_COMM_WORLD);
  EXPECT_LT(unevenness(mesh, c, flow), 1e-12);
}

struct Errors {
  double velocity, pressure; ///< root mean square
};

/// Decaying vortices, exact: u = -cos x sin y e^(-2 nu t), v = sin x cos y e^(-2 nu t).
Errors taylor_green(int n, int steps, TimeScheme scheme, double viscosity = 0.1) {
  constexpr double end = 0.6, nu = 0.1;
  GasCase c;
  c.fluid.density = 1;
  c.fluid.viscosity = viscosity;
  c.numerics.convection = ConvectionScheme::central;
  c.numerics.time_scheme = scheme;
  const Mesh mesh = dealt(skewed_square(n, 2 * pi));
  GasSolver gas(mesh, c);
  const auto exact = [&](const Vec3& x, double t) {
    const double decay = std::exp(-2 * nu * t);
    return Vec3{-std::cos(x.x) * std::sin(x.y) * decay, std::sin(x.x) * std::cos(x.y) * decay, 0};
  };
  BlockVectors start = make_vectors(mesh);
  for_each_cell(mesh, [&](std::size_t b, std::ptrdiff_t p, const Vec3& x) {
    for (int m = 0; m < 3; ++m)
      start[b][std::size_t(m)][p] = exact(x, 0)[m];
  });
  const BlockFields one = make_fields(mesh, 1);
  gas.initialise(one, start);
  for (int s = 0; s < steps; ++s) {
    gas.advance(end / steps, one, nullptr);
    EXPECT_LT(norm(gas.balance().momentum_residual), 1e-11 * gas.balance().momentum_scale + 1e-13);
  }
  const double middle = end - 0.5 * end / steps; // the pressure holds in the middle of a step
  double sums[4] = {0, 0, 0, 0};                 // squares, volume, mean pressure error
  const auto pressure_error = [&](std::size_t b, std::ptrdiff_t p, const Vec3& x) {
    return gas.pressure()[b][p] +
           0.25 * (std::cos(2 * x.x) + std::cos(2 * x.y)) * std::exp(-4 * nu * middle);
  };
  for_each_cell(mesh, [&](std::size_t b, std::ptrdiff_t p, const Vec3& x) {
    const double volume = mesh.local[b].volume[p];
    const VectorField& u = gas.velocity()[b];
    const Vec3 e = Vec3{u[0][p], u[1][p], u[2][p]} - exact(x, end);
    const double q = pressure_error(b, p, x);
    sums[0] += volume * dot(e, e), sums[1] += volume * q * q;
    sums[2] += volume, sums[3] += volume * q;
  });
  MPI_Allreduce(MPI_IN_PLACE, sums, 4, MPI_DOUBLE, MPI_SUM, MPI_COMM_WORLD);
  const double mean = sums[3] / sums[2];
  return {std::sqrt(sums[0] / sums[2]), std::sqrt(sums[1] / sums[2] - mean * mean)};
}

TEST(SkewedMesh, SecondOrderAcrossBentBlockSides) {
  for (const TimeScheme scheme : {TimeScheme::semi_implicit, TimeScheme::implicit}) {
    const Errors coarse = taylor_green(16, 16, scheme), fine = taylor_green(32, 32, scheme);
    EXPECT_LT(fine.velocity, 3e-4);
    EXPECT_GT(std::log2(coarse.velocity / fine.velocity), 1.9);
    EXPECT_GT(std::log2(coarse.pressure / fine.pressure), 1.9);
  }
  EXPECT_GT(taylor_green(32, 32, TimeScheme::semi_implicit, 0.105).velocity, 3e-3)
      << "a wrong viscosity is seen";
}

} // namespace
