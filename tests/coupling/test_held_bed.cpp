// SPDX-FileCopyrightText: 2026 The GranFlux developers
// SPDX-License-Identifier: BSD-3-Clause

// Particles that stiff springs hold in place, as contacts do in a packed bed, in light gas under a
// driving pressure gradient: the gas goes to the velocity at which drag bears the gradient, through
// the hand-over. Stable up to intervals of 1.5 response times.

#include <cmath>
#include <gtest/gtest.h>

#include "fake_host.hpp"

namespace {

using namespace granflux;
using granflux::testing::FakeHost;
using granflux::testing::Particle;
using granflux::testing::sphere;

/// Gas velocity over that of the steady state after 30 intervals of T = stiffness * m/b.
double gas_after(double stiffness) {
  const double radius = std::cbrt(0.4 / 8 * 3 / (4 * std::numbers::pi)), d = 2 * radius;
  cfd::GasCase c;
  for (auto& nodes : box_grid(c).nodes)
    nodes = cfd::uniform_nodes(0, 4, 4);
  box_grid(c).periodic = {true, true, true};
  c.fluid.density = 1.2;
  c.fluid.viscosity = 1000 * d * d / (18 * 0.6 * 0.4);     // beta = 1000 kg/(m3 s)
  c.fluid.driving_pressure_gradient = {0, 0, -1000 / 0.6}; // eps grad p = -beta u at 1 m/s
  c.initial_velocity = {0, 0, 1};
  coupling::CouplingOptions options;
  options.drag = "stokes";
  options.void_fraction = "trilinear";
  coupling::Coupler coupler(c, options, MPI_COMM_WORLD);
  FakeHost host({0, 0, 0}, {4, 4, 4}, {true, true, true}, MPI_COMM_WORLD);
  const auto height = [](std::int64_t id) { return (double(id / 64) + 0.5) * 0.5; };
  for (int p = 0; p < 512; ++p)
    host.add(
        sphere(p, {(p % 8 + 0.5) * 0.5, (p / 8 % 8 + 0.5) * 0.5, height(p)}, {}, radius, 1000));
  const double interval = stiffness * 400 / 1000.;
  const int every = 20;
  const double dt = interval / every, frequency = 0.3 / dt; // critically damped
  host.other_force = [&](const Particle& q) {
    const double displaced = std::remainder(q.position.z - height(q.id), 4.);
    return Vec3{0, 0, -q.mass * frequency * (frequency * displaced + 2 * q.velocity.z)};
  };
  coupler.initialise(host.view(), 0);
  for (int step = 0; step < 30 * every; ++step)
    host.step(coupler, dt, step % every == 0, interval);
  EXPECT_GT(coupler.report().stiffness_max, 0.99 * stiffness);
  EXPECT_LT(coupler.report().momentum_residual, 1e-12);
  return coupler.gas().balance().momentum.z / (0.6 * 1.2 * 64);
}

TEST(HeldBed, GasReachesTheVelocityAtWhichDragBearsThePressure) {
  for (const double stiffness : {0.5, 1.4})
    EXPECT_NEAR(gas_after(stiffness), 1, 0.01) << "interval over response time " << stiffness;
}

TEST(HeldBed, LimitIsWhereTheTheorySays) {
  EXPECT_GT(std::abs(gas_after(2) - 1), 1);
}

} // namespace
