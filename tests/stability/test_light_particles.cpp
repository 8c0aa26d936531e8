// SPDX-FileCopyrightText: 2026 The GranFlux developers
// SPDX-License-Identifier: BSD-3-Clause

// Particles about as heavy as the fluid, and lighter ones that rise. There is no added mass; what
// is explicit is the pressure force of model A: the particles feel the gradient of the last
// interval, and what they gain by it pushes the fluid in the next one. That multiplies their
// acceleration by -(1-eps) rho / (eps rho_p), halved by the steps' averages: stable below 2.

#include <cmath>
#include <gtest/gtest.h>
#include <map>
#include <random>

#include <granflux/cfd/error.hpp>
#include <granflux/coupling/drag/wen_yu.hpp>

#include "duct.hpp"

namespace {

using namespace granflux;
using namespace granflux::testing;

constexpr double d = 1e-3, rho = 1000, mu = 1e-3, g = 9.81; // water
constexpr int cells = 4;
constexpr double cell = 3 * d, size = cells * cell;

cfd::GasCase water(double driving) {
  cfd::GasCase c;
  for (auto& nodes : box_grid(c).nodes)
    nodes = cfd::uniform_nodes(0, size, cells);
  box_grid(c).periodic = {true, true, true};
  c.fluid = {.density = rho,
             .viscosity = mu,
             .gravity = {0, 0, -g},
             .driving_pressure_gradient = {0, 0, driving}};
  c.numerics.pressure_tolerance = c.numerics.viscous_tolerance = 1e-13;
  return c;
}

/// Slip at which drag bears the weight less buoyancy, eps (rho_p - rho) V g, by bisection; of the
/// fluid, upwards.
double hovering_slip(double density_ratio, double eps) {
  const double excess = eps * (density_ratio - 1) * rho * sphere_volume(d / 2) * g;
  double low = 0, high = 1;
  for (int i = 0; i < 200; ++i) {
    const double u = 0.5 * (low + high), re = rho * eps * u * d / mu;
    const double drag = 3 * std::numbers::pi * mu * d * eps * u *
                        coupling::WenYu{}({.reynolds = re, .void_fraction = eps});
    (drag < std::abs(excess) ? low : high) = u;
  }
  return std::copysign(low, excess);
}

// A lattice of free particles under the pressure gradient that bears the mixture, from rest: their
// slip goes to the closed form from one side, without turning back in any step.
TEST(LightParticles, SlipGoesToTheTerminalOneWithoutOddAndEven) {
  const int n = cells * 2;
  const double a = size / n, eps = 1 - sphere_volume(d / 2) / (a * a * a);
  for (const auto model : {coupling::MomentumModel::a, coupling::MomentumModel::b})
    for (const double ratio : {1.05, 1., 0.5})
      for (const double dt : {2e-3, 5e-4}) {
        coupling::CouplingOptions options;
        options.drag = "wen_yu";
        options.model = model;
        coupling::Coupler coupler(water(-(1 - eps) * (ratio - 1) * rho * g), options,
                                  MPI_COMM_WORLD);
        FakeHost host({0, 0, 0}, {size, size, size}, {true, true, true}, MPI_COMM_WORLD);
        host.gravity = {0, 0, -g};
        add_lattice(host, {n, n, n}, a, d, ratio * rho, false);
        coupler.initialise(host.view(), 0);
        const double end = hovering_slip(ratio, eps), way = end < 0 ? -1 : 1;
        double slip = 0;
        for (int step = 0; step < int(0.5 / dt); ++step) {
          host.step(coupler, dt, true, dt);
          const double next = host.fluid[0].gas_velocity.z - host.velocity[0].z;
          EXPECT_GE(way * (next - slip), -1e-3 * std::abs(end) - 1e-15)
              << ratio << ' ' << dt << ' ' << step;
          slip = next;
        }
        EXPECT_NEAR(slip, end, 1e-3 * std::abs(end) + 1e-12) << ratio << ' ' << dt;
        EXPECT_LT(coupler.report().momentum_residual, 1e-12);
      }
}

/// Fastest particle, over the terminal slip of one alone, in a swarm anywhere in the box; infinite
/// where a cell is overfull or the fluid stops being a number.
double swarm(double ratio, coupling::MomentumModel model, double dt, int steps,
             const char* kernel = "smoothed") {
  constexpr int count = 600;
  const double share = count * sphere_volume(d / 2) / (size * size * size);
  coupling::CouplingOptions options;
  options.drag = "wen_yu";
  options.void_fraction = kernel;
  options.model = model;
  coupling::Coupler coupler(water(-share * (ratio - 1) * rho * g), options, MPI_COMM_WORLD);
  FakeHost host({0, 0, 0}, {size, size, size}, {true, true, true}, MPI_COMM_WORLD);
  host.gravity = {0, 0, -g};
  std::mt19937 random(7);
  std::uniform_real_distribution<double> anywhere(0, size);
  for (int p = 0; p < count; ++p)
    host.add(
        sphere(p, {anywhere(random), anywhere(random), anywhere(random)}, {}, d / 2, ratio * rho));
  coupler.initialise(host.view(), 0);
  double fastest = 0;
  try {
    for (int step = 0; step < steps; ++step) {
      host.step(coupler, dt, true, dt);
      EXPECT_LT(coupler.report().volume_residual, 1e-12);
      for (const Vec3& v : host.velocity)
        fastest = std::max(fastest, norm(v));
    }
  } catch (const NumericalError&) {
    return HUGE_VAL;
  }
  return fastest / std::abs(hovering_slip(ratio, 1));
}

TEST(LightParticles, RisingAndSinkingSwarmsStayNearTheirTerminalVelocity) {
  for (const auto model : {coupling::MomentumModel::a, coupling::MomentumModel::b})
    for (const double ratio : {2.5, 1.05, 0.5})
      EXPECT_LT(swarm(ratio, model, 1e-3, 200), 2) << ratio;
}

// A few particles a cell: (1-eps)/eps is 0.22 in the mean and 0.5 where it is densest, so model A's
// limit is a ratio between 0.11 and 0.25.
TEST(LightParticles, ExplicitPressureForceHasItsLimit) {
  for (const double dt : {1e-3, 1e-4}) {
    EXPECT_LT(swarm(0.5, coupling::MomentumModel::a, dt, 200, "trilinear"), 2) << dt;
    EXPECT_GT(swarm(0.03, coupling::MomentumModel::a, dt, 200, "trilinear"), 4) << dt;
    EXPECT_LT(swarm(0.03, coupling::MomentumModel::b, dt, 200, "trilinear"), 2) << dt; // has none
  }
}

} // namespace
