// SPDX-FileCopyrightText: 2026 The GranFlux developers
// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <granflux/cfd/boundary.hpp>

#include "box_case.hpp"

using namespace granflux;
using namespace granflux::cfd;
using namespace granflux::cfd::testing;

namespace {

/// A duct along z, inlet below, outlet above, periodic in y.
GasCase duct(double width) {
  GasCase c = box_case({8, 2, 6}, {width, 0.5, 1}, {false, true, false});
  boundary(c, "z_low").kind = BoundaryKind::inlet;
  boundary(c, "z_low").velocity = {0, 0, 2};
  boundary(c, "z_high").kind = BoundaryKind::outlet;
  return c;
}

TEST(Boundaries, ParabolicInletHasItsMeanAndItsShape) {
  GasCase c = duct(0.4);
  box_grid(c).nodes[0] = {0, 0.02, 0.06, 0.12, 0.2, 0.28, 0.34, 0.38, 0.4}; // any spacing
  boundary(c, "z_low").profile = BoundaryCondition::Profile::parabolic;
  const Mesh mesh = make_mesh(c, MPI_COMM_WORLD);
  const Boundaries boundaries(mesh, c.boundaries);
  for (const BoundaryPatch& patch : boundaries.patches()) {
    if (boundaries.condition(patch).name != "z_low")
      continue;
    const Block& block = mesh.local[std::size_t(patch.block)];
    for (const BoundaryFace& face : patch.faces) {
      // Mean of 6 s (1-s) over the face, by Simpson's rule, which is exact for it.
      const auto parabola = [](double x) { return 6 * x / 0.4 * (1 - x / 0.4); };
      const double a = block.node[0][face.cell], b = block.node[0][face.cell + 1];
      const double mean = (parabola(a) + 4 * parabola(0.5 * (a + b)) + parabola(b)) / 6;
      EXPECT_NEAR(boundaries.velocity(patch, face, 0).z, 2 * mean, 1e-13);
    }
  }
  GasSolver gas(mesh, c);
  gas.advance(1e-3, make_fields(mesh, 1), nullptr);
  EXPECT_NEAR(gas.boundary_flux("z_low"), -2 * 0.4 * 0.5, 1e-14);
  EXPECT_NEAR(gas.boundary_flux("z_high"), 2 * 0.4 * 0.5, 1e-12);
}

TEST(Boundaries, ParabolicInletIsFlatBetweenSlipSides) {
  GasCase c = box_case({8, 3, 4}, {0.4, 0.5, 1}, {false, false, false});
  boundary(c, "z_low").kind = BoundaryKind::inlet;
  boundary(c, "z_low").velocity = {0, 0, 2};
  boundary(c, "z_low").profile = BoundaryCondition::Profile::parabolic;
  boundary(c, "z_high").kind = BoundaryKind::outlet;
  boundary(c, "y_low").kind = boundary(c, "y_high").kind = BoundaryKind::slip;
  const Mesh mesh = make_mesh(c, MPI_COMM_WORLD);
  const Boundaries boundaries(mesh, c.boundaries);
  for (const BoundaryPatch& patch : boundaries.patches())
    if (boundaries.condition(patch).name == "z_low")
      for (const BoundaryFace& face : patch.faces) {
        const Block& block = mesh.local[std::size_t(patch.block)];
        const double a = block.node[0][face.cell] / 0.4, b = a + 0.125;
        const double mean = (3 * (b * b - a * a) - 2 * (b * b * b - a * a * a)) / 0.125;
        EXPECT_NEAR(boundaries.velocity(patch, face, 0).z, 2 * mean, 1e-13); // of x only
      }
}

TEST(Boundaries, InletVelocityGrowsOverItsRamp) {
  GasCase c = duct(0.4);
  boundary(c, "z_low").ramp_time = 0.2;
  boundary(c, "z_low").ramp_from = 0.25;
  const Mesh mesh = make_mesh(c, MPI_COMM_WORLD);
  GasSolver gas(mesh, c);
  const BlockFields one = make_fields(mesh, 1);
  for (int s = 1; s <= 6; ++s) {
    gas.advance(0.05, one, nullptr);
    const double share = 0.25 + 0.75 * std::min(1.0, s * 0.05 / 0.2);
    EXPECT_NEAR(gas.boundary_flux("z_high"), 2 * share * 0.2, 1e-12) << s;
  }
}

TEST(Boundaries, InletIsSuperficial) {
  GasCase c = duct(0.4);
  boundary(c, "x_low").kind = boundary(c, "x_high").kind = BoundaryKind::slip;
  const Mesh mesh = make_mesh(c, MPI_COMM_WORLD);
  GasSolver gas(mesh, c);
  const BlockFields eps = make_fields(mesh, 0.4);
  gas.initialise(eps, Vec3{0, 0, 5});
  gas.advance(1e-3, eps, nullptr);
  EXPECT_LT(largest(mesh, [&](std::size_t b, std::ptrdiff_t p,
                              const Vec3&) { return gas.velocity()[b][2][p] - 2 / 0.4; }),
            1e-12);
}

TEST(Boundaries, UniformFlowPassesBetweenSlipWalls) {
  GasCase c = duct(0.4);
  boundary(c, "x_low").kind = boundary(c, "x_high").kind = BoundaryKind::slip;
  c.initial_velocity = {0, 0, 2};
  const Mesh mesh = make_mesh(c, MPI_COMM_WORLD);
  GasSolver gas(mesh, c);
  const BlockFields one = make_fields(mesh, 1);
  for (int s = 0; s < 20; ++s)
    gas.advance(0.02, one, nullptr);
  const Vec3 uniform{0, 0, 2};
  for (int m = 0; m < 3; ++m)
    EXPECT_LT(largest(mesh,
                      [&](std::size_t b, std::ptrdiff_t p, const Vec3&) {
                        return gas.velocity()[b][std::size_t(m)][p] - uniform[m];
                      }),
              1e-12);
}

TEST(Boundaries, JetThroughPartOfASideKeepsMass) {
  GasCase c = duct(0.4);
  box_grid(c).patches[2] = {
      "z_low", {2, false}, {0.1, 0, 0}, {0.2, 1, 0}}; // x_low, x_high come first
  ASSERT_EQ(c.boundaries[2].name, "z_low");
  box_grid(c).patches.push_back({"left", {2, false}, {0, 0, 0}, {0.1, 1, 0}});
  box_grid(c).patches.push_back({"right", {2, false}, {0.2, 0, 0}, {0.4, 1, 0}});
  for (const char* name : {"left", "right"}) {
    BoundaryCondition wall;
    wall.name = name;
    c.boundaries.push_back(wall);
  }
  const Mesh mesh = make_mesh(c, MPI_COMM_WORLD);
  GasSolver gas(mesh, c);
  const BlockFields one = make_fields(mesh, 1);
  for (int s = 0; s < 5; ++s)
    gas.advance(0.005, one, nullptr);
  EXPECT_NEAR(gas.boundary_flux("z_low"), -2 * 0.1 * 0.5, 1e-14);
  EXPECT_NEAR(gas.boundary_flux("z_high"), 2 * 0.1 * 0.5, 1e-12);
  EXPECT_EQ(gas.boundary_flux("left"), 0);
  EXPECT_LT(norm(gas.balance().momentum_residual), 1e-12 * gas.balance().momentum_scale);
}

} // namespace
