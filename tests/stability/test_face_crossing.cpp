// SPDX-FileCopyrightText: 2026 The GranFlux developers
// SPDX-License-Identifier: BSD-3-Clause

// A particle is dragged at constant speed through gas at rest, from cell to cell, with ever smaller
// steps. Continuity has d(eps)/dt: a share that jumps moves gas at V_p / (V_c dt) times the cell,
// at once, so pressure goes with 1/dt^2; a share that has a kink moves it at a speed that does not
// depend on the step, and only where the kink is passed pressure goes with 1/dt: an impulse, that
// of the gas set in motion, which is the same for any step. A share without either moves it at a
// speed that changes gradually: nothing grows.

#include <cmath>
#include <gtest/gtest.h>

#include "duct.hpp"

namespace {

using namespace granflux;
using namespace granflux::testing;

constexpr double d = 1.2e-3, dx = 2e-3, dz = 2.5e-3, speed = 0.5;

struct Peak {
  double pressure = 0; ///< Pa
  double velocity = 0; ///< m/s
};

/// Over a way of 0.3 cells from `from` (in cells); the first third, in which the gas is set in
/// motion, is left out.
Peak drag_along(const char* kernel, double from, double dt) {
  cfd::GasCase c = closed_box({8, 4, 4}, dx);
  box_grid(c).nodes[2] = cfd::uniform_nodes(0, 4 * dz, 4);
  c.boundaries[1].kind = cfd::BoundaryKind::outlet; // at the end of the way
  c.numerics.pressure_tolerance = 1e-12;
  coupling::CouplingOptions options;
  options.void_fraction = kernel;
  options.drag = "stokes";
  coupling::Coupler coupler(c, options, MPI_COMM_WORLD);
  FakeHost host({0, 0, 0}, {8 * dx, 4 * dx, 4 * dz}, {}, MPI_COMM_WORLD);
  host.add(sphere(1, {from * dx, 2.3 * dx, 2.4 * dz}, {speed, 0, 0}, d / 2, 1e9));
  coupler.initialise(host.view(), 0);
  Peak peak;
  const int steps = int(std::round(0.3 * dx / speed / dt));
  for (int step = 0; step < steps; ++step) {
    host.step(coupler, dt, true, dt); // too heavy for the gas to slow it down
    if (step < steps / 3)
      continue;
    EXPECT_LT(coupler.report().volume_residual, 1e-12);
    const auto& gas = coupler.gas();
    peak.pressure =
        std::max(peak.pressure, largest(coupler.mesh(), [&](std::size_t b, std::ptrdiff_t p) {
                   return std::abs(gas.pressure()[b][p]);
                 }));
    peak.velocity =
        std::max(peak.velocity, largest(coupler.mesh(), [&](std::size_t b, std::ptrdiff_t p) {
                   return std::abs(gas.velocity()[b][0][p]);
                 }));
  }
  return peak;
}

struct Orders {
  double pressure = 0, velocity = 0;
};

/// Powers of 1/dt with which the peaks grow from a coarse step on, the worse of a way through a
/// face and one through a cell's centre.
Orders orders(const char* kernel, double coarse_step = 2e-5) {
  Orders worst{-10, -10};
  for (const double from : {3.85, 4.35}) {
    const Peak coarse = drag_along(kernel, from, coarse_step),
               fine = drag_along(kernel, from, 1e-6);
    worst.pressure = std::max(worst.pressure, std::log(fine.pressure / coarse.pressure) /
                                                  std::log(coarse_step / 1e-6));
    worst.velocity = std::max(worst.velocity, std::log(fine.velocity / coarse.velocity) /
                                                  std::log(coarse_step / 1e-6));
  }
  return worst;
}

TEST(FaceCrossing, SharesThatJumpMoveGasWithoutBoundAsTheStepGoesToZero) {
  for (const char* kernel : {"centre", "divided"}) {
    const Orders growth = orders(kernel);
    EXPECT_NEAR(growth.pressure, 2, 0.1) << kernel;
    EXPECT_NEAR(growth.velocity, 1, 0.1) << kernel;
  }
  EXPECT_GT(drag_along("centre", 3.85, 1e-5).velocity, 5 * speed);
}

TEST(FaceCrossing, ContinuousSharesMoveItAsFastWhateverTheStep) {
  for (const char* kernel : {"trilinear", "smoothed"}) {
    const Orders growth = orders(kernel);
    EXPECT_LT(growth.pressure, 1.05) << kernel; // the impulse of the kink, p dt, is bounded
    EXPECT_LT(growth.velocity, 0.15) << kernel;
    EXPECT_LT(drag_along(kernel, 4.35, 1e-6).velocity, 0.1 * speed) << kernel;
  }
  EXPECT_LT(20 * drag_along("smoothed", 4.35, 1e-6).pressure,
            2 * drag_along("trilinear", 4.35, 1e-6).pressure);
}

TEST(FaceCrossing, SharesWithoutKinksKeepThePressureBoundedAsTheStepGoesToZero) {
  const Orders growth = orders("spline", 5e-6);
  EXPECT_LT(growth.pressure, 0.05);
  EXPECT_LT(growth.velocity, 0.15);
  const double bounded = drag_along("spline", 4.35, 1e-6).pressure;
  EXPECT_GT(drag_along("trilinear", 4.35, 1e-6).pressure, 500 * bounded);
}

} // namespace
