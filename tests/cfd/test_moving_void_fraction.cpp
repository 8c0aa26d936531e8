// SPDX-FileCopyrightText: 2026 The GranFlux developers
// SPDX-License-Identifier: BSD-3-Clause

// A wave of void fraction runs through a periodic gas: eps = 0.7 + 0.1 sin(k x - w t). Continuity
// is met by eps u = q0 + (w/k) (eps - 0.7); a momentum source makes that, with no pressure, an
// exact solution. The velocity of a step holds in the middle between the void fractions at its
// ends.
#include <gtest/gtest.h>

#include "box_case.hpp"

using namespace granflux;
using namespace granflux::cfd;
using namespace granflux::cfd::testing;

namespace {

constexpr double k = 2 * pi, w = 2.5, q0 = 0.5, c = w / k;

double eps(double x, double t) {
  return 0.7 + 0.1 * std::sin(k * x - w * t);
}
double velocity(double x, double t) {
  return (q0 + c * (eps(x, t) - 0.7)) / eps(x, t);
}
/// d(eps u)/dt + d(eps u u)/dx
double source(double x, double t) {
  const double slope = 0.1 * k * std::cos(k * x - w * t); // of eps in x
  const double e = eps(x, t), q = q0 + c * (e - 0.7), dq = c * slope;
  return -c * dq + (2 * q * dq * e - q * q * slope) / (e * e);
}

/// Errors of velocity and pressure.
std::array<double, 2> errors(int n, int steps, double source_factor = 1) {
  constexpr double end = 0.5;
  GasCase gas_case = box_case({n, 2, 2}, {1, 1, 1}, {true, true, true});
  gas_case.fluid.viscosity = 0;
  gas_case.numerics.convection = ConvectionScheme::central;
  const Mesh mesh = make_mesh(gas_case, MPI_COMM_WORLD);
  GasSolver gas(mesh, gas_case);
  const double dt = end / steps;
  BlockFields e = make_fields(mesh, 1);
  MomentumExchange exchange = make_exchange(mesh);
  BlockVectors start = make_vectors(mesh);
  const auto set_eps = [&](double t) {
    for_each_cell(mesh,
                  [&](std::size_t b, std::ptrdiff_t p, const Vec3& x) { e[b][p] = eps(x.x, t); });
  };
  set_eps(0);
  for_each_cell(mesh, [&](std::size_t b, std::ptrdiff_t p, const Vec3& x) {
    start[b][0][p] = velocity(x.x, 0);
  });
  gas.initialise(e, start);
  for (int s = 0; s < steps; ++s) {
    set_eps((s + 1) * dt);
    for_each_cell(mesh, [&](std::size_t b, std::ptrdiff_t p, const Vec3& x) {
      exchange.pressure_fraction[b][p] = eps(x.x, (s + 0.5) * dt);
      // The first step goes from time 0 to the middle of the interval only.
      exchange.drag_source[b][0][p] =
          source_factor * (s == 0 ? 0.5 * source(x.x, 0.25 * dt) : source(x.x, s * dt));
    });
    const StepReport report = gas.advance(dt, e, &exchange);
    EXPECT_LT(report.continuity_residual, 1e-11);
    EXPECT_FALSE(report.history_restarted);
    EXPECT_LT(norm(gas.balance().momentum_residual), 1e-12 * gas.balance().momentum_scale);
  }
  return {largest(mesh,
                  [&](std::size_t b, std::ptrdiff_t p, const Vec3& x) {
                    return gas.velocity()[b][0][p] - velocity(x.x, end - 0.5 * dt);
                  }),
          largest(mesh, [&](std::size_t b, std::ptrdiff_t p, const Vec3&) {
            return gas.pressure()[b][p];
          })};
}

TEST(MovingVoidFraction, SecondOrderInSpaceAndTime) {
  const auto coarse = errors(32, 50), fine = errors(64, 100);
  EXPECT_LT(fine[0], 2e-4);
  EXPECT_LT(fine[1], 1e-4);
  EXPECT_GT(std::log2(coarse[0] / fine[0]), 1.9);
  EXPECT_GT(std::log2(coarse[1] / fine[1]), 1.9);
}

TEST(MovingVoidFraction, SeesAFivePercentErrorInTheSource) {
  EXPECT_GT(errors(64, 100, 0.95)[1], 1e-4);
}

} // namespace
