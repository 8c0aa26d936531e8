// SPDX-FileCopyrightText: 2026 The GranFlux developers
// SPDX-License-Identifier: BSD-3-Clause

// Decaying vortices in a periodic square of side 2 pi, an exact solution of the Navier-Stokes
// equations: u = -cos x sin y e^(-2 nu t), v = sin x cos y e^(-2 nu t).
#include <gtest/gtest.h>

#include "box_case.hpp"

using namespace granflux;
using namespace granflux::cfd;
using namespace granflux::cfd::testing;

namespace {

constexpr double nu = 0.1;

Vec3 exact(const Vec3& x, double t) {
  const double decay = std::exp(-2 * nu * t);
  return {-std::cos(x.x) * std::sin(x.y) * decay, std::sin(x.x) * std::cos(x.y) * decay, 0};
}

/// Velocity error and pressure error (about the mean) at `end`.
std::array<double, 2> errors(int n, int steps, ConvectionScheme scheme, double viscosity = nu) {
  constexpr double end = 1;
  GasCase c = box_case({n, n, 1}, {2 * pi, 2 * pi, 2 * pi / n}, {true, true, true});
  c.numerics.convection = scheme;
  c.fluid.viscosity = viscosity;
  c.numerics.pressure_tolerance = 1e-12; // continuity is asked to hold to 1e-11
  const Mesh mesh = make_mesh(c, MPI_COMM_WORLD);
  GasSolver gas(mesh, c);
  const BlockFields one = make_fields(mesh, 1);
  BlockVectors start = make_vectors(mesh);
  for_each_cell(mesh, [&](std::size_t b, std::ptrdiff_t p, const Vec3& x) {
    for (int m = 0; m < 3; ++m)
      start[b][std::size_t(m)][p] = exact(x, 0)[m];
  });
  gas.initialise(one, start);
  for (int s = 0; s < steps; ++s) {
    const StepReport report = gas.advance(end / steps, one, nullptr);
    EXPECT_LT(report.continuity_residual, 1e-11);
  }
  const double middle = end - 0.5 * end / steps; // the pressure holds in the middle of a step
  return {largest(mesh,
                  [&](std::size_t b, std::ptrdiff_t p, const Vec3& x) {
                    const Vec3 u = exact(x, end);
                    return std::hypot(gas.velocity()[b][0][p] - u.x, gas.velocity()[b][1][p] - u.y);
                  }),
          largest(mesh, [&](std::size_t b, std::ptrdiff_t p, const Vec3& x) {
            return gas.pressure()[b][p] +
                   0.25 * (std::cos(2 * x.x) + std::cos(2 * x.y)) * std::exp(-4 * nu * middle);
          })};
}

TEST(TaylorGreen, SecondOrderInSpaceAndTime) {
  for (const auto scheme : {ConvectionScheme::central, ConvectionScheme::upwind2}) {
    const auto coarse = errors(48, 30, scheme), fine = errors(96, 60, scheme);
    EXPECT_LT(fine[0], 2e-4);
    EXPECT_LT(fine[1], 1.5e-3);
    EXPECT_GT(std::log2(coarse[0] / fine[0]), 1.9);
    EXPECT_GT(std::log2(coarse[1] / fine[1]), 1.9);
  }
}

TEST(TaylorGreen, LimitedSchemeConverges) {
  // A limiter is first order at extrema: the largest error falls more slowly than the others.
  const auto coarse = errors(32, 20, ConvectionScheme::limited);
  const auto fine = errors(64, 40, ConvectionScheme::limited);
  EXPECT_LT(fine[0], 1e-2);
  EXPECT_GT(std::log2(coarse[0] / fine[0]), 1.4);
}

TEST(TaylorGreen, SeesAFivePercentErrorInViscosity) {
  EXPECT_GT(errors(64, 40, ConvectionScheme::central, 1.05 * nu)[0], 3e-3);
}

} // namespace
