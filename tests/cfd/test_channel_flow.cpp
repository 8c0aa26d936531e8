// SPDX-FileCopyrightText: 2026 The GranFlux developers
// SPDX-License-Identifier: BSD-3-Clause

// Plane channel of width 1, viscosity mu, pressure gradient -G, upper wall moving with V:
// u = G y (1-y) / (2 mu) + V y.
#include <gtest/gtest.h>

#include "box_case.hpp"

using namespace granflux;
using namespace granflux::cfd;
using namespace granflux::cfd::testing;

namespace {

constexpr double mu = 0.1, gradient = 0.4;

double error(int n, double wall, double factor = 1) {
  GasCase c = box_case({2, n, 2}, {1, 1, 1}, {true, false, true});
  c.fluid.viscosity = mu * factor;
  c.fluid.driving_pressure_gradient = {-gradient, 0, 0};
  boundary(c, "y_high").velocity = {wall, 0, 0};
  const Mesh mesh = make_mesh(c, MPI_COMM_WORLD);
  GasSolver gas(mesh, c);
  const BlockFields one = make_fields(mesh, 1);
  for (int s = 0; s < 300; ++s) // three diffusion times: e^(-3 pi^2) of the start is left
    gas.advance(0.1, one, nullptr);
  EXPECT_LT(norm(gas.balance().momentum_residual), 1e-12 * gas.balance().momentum_scale);
  EXPECT_NEAR(gas.balance().friction.x, -gradient, 1e-9); // the walls bear the pressure drop
  return largest(mesh, [&](std::size_t b, std::ptrdiff_t p, const Vec3& x) {
    return gas.velocity()[b][0][p] - gradient * x.y * (1 - x.y) / (2 * mu) - wall * x.y;
  });
}

TEST(ChannelFlow, PoiseuilleIsSecondOrder) {
  const double coarse = error(8, 0), fine = error(16, 0);
  EXPECT_LT(fine, 0.003);
  EXPECT_NEAR(std::log2(coarse / fine), 2, 0.1);
}

TEST(ChannelFlow, CouettePoiseuilleIsSecondOrder) {
  const double coarse = error(8, 0.7), fine = error(16, 0.7);
  EXPECT_LT(fine, 0.003);
  EXPECT_NEAR(std::log2(coarse / fine), 2, 0.1);
}

TEST(ChannelFlow, SeesAFivePercentErrorInViscosity) {
  EXPECT_GT(error(16, 0, 1.05), 0.003);
}

} // namespace
