// SPDX-FileCopyrightText: 2026 The GranFlux developers
// SPDX-License-Identifier: BSD-3-Clause
//
// A light sphere of 100 um in an upflow of air in cells of two diameters: what it does to the gas,
// and the gas to it, with parts of the exchange off. Against closed forms.

#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "fake_host.hpp"

namespace {

using namespace granflux;
using granflux::testing::FakeHost;
using granflux::testing::sphere;

constexpr double d = 100e-6, solid_density = 20, g = 9.80665, upflow = 0.005, cell = 2 * d;
constexpr double gas_density = 1.2, viscosity = 1.8e-5;

cfd::GasCase make_case() {
  cfd::GasCase c;
  box_grid(c).nodes = {cfd::uniform_nodes(0, 5 * cell, 5), cfd::uniform_nodes(0, 20 * cell, 20),
                       cfd::uniform_nodes(0, 5 * cell, 5)};
  box_grid(c).patches = {{"in", {1, false}},  {"out", {1, true}},    {"west", {0, false}},
                         {"east", {0, true}}, {"front", {2, false}}, {"back", {2, true}}};
  for (const char* side : {"west", "east", "front", "back"})
    c.boundaries.push_back({.name = side, .kind = cfd::BoundaryKind::slip});
  c.boundaries.push_back(
      {.name = "in", .kind = cfd::BoundaryKind::inlet, .velocity = {0, upflow, 0}});
  c.boundaries.push_back({.name = "out", .kind = cfd::BoundaryKind::outlet});
  c.fluid = {.density = gas_density, .viscosity = viscosity, .gravity = {0, -g, 0}};
  c.initial_velocity = {0, upflow, 0};
  return c;
}

/// Velocity of the sphere, let go at rest, after a time in steps of dt.
double velocity_after(const coupling::ExchangeEffects& effects, double dt, int steps,
                      coupling::ExchangeReport* report = nullptr) {
  coupling::CouplingOptions options;
  options.drag = "schiller_naumann";
  options.effects = effects;
  coupling::Coupler coupler(make_case(), options, MPI_COMM_WORLD);
  FakeHost host({0, 0, 0}, {5 * cell, 20 * cell, 5 * cell}, {}, MPI_COMM_WORLD);
  host.gravity = {0, -g, 0};
  host.add(sphere(1, {2.3 * cell, 10.4 * cell, 2.7 * cell}, {}, d / 2, solid_density));
  coupler.initialise(host.view(), 0);
  for (int s = 0; s < steps; ++s)
    host.step(coupler, dt, true, dt);
  if (report)
    *report = coupler.report();
  return host.momentum().y / (solid_density * granflux::testing::sphere_volume(d / 2));
}

/// Slip at which drag holds the weight of a sphere in gas of `buoyant` density.
double terminal_slip(double buoyant) {
  const double weight = (solid_density - buoyant) * granflux::testing::sphere_volume(d / 2) * g;
  double slip = 0.005;
  for (int i = 0; i < 200; ++i) {
    const double re = gas_density * slip * d / viscosity;
    slip = weight / (3 * std::numbers::pi * viscosity * d * (1 + 0.15 * std::pow(re, 0.687)));
  }
  return slip;
}

constexpr double long_step = 1e-3; // s, more than the response time

TEST(OneWay, TerminalSlipInUndisturbedGas) {
  coupling::ExchangeReport report;
  const double v = velocity_after({.two_way = false}, long_step, 30, &report);
  // In the small cells it would be off by a tenth if the sphere took the gas along.
  EXPECT_NEAR(upflow - v, terminal_slip(gas_density), 1e-9);
  EXPECT_EQ(report.void_fraction_min, 1);
  EXPECT_EQ(report.particles, 1);
  EXPECT_EQ(norm(report.impulse_from_gas), 0);
  EXPECT_EQ(report.momentum_residual, 0);
  EXPECT_NEAR(report.particle_volume, granflux::testing::sphere_volume(d / 2), 1e-25);
}

TEST(OneWay, TwoWaysItDisturbsTheGas) {
  const double v = velocity_after({}, long_step, 30);
  EXPECT_GT(std::abs(upflow - v - terminal_slip(gas_density)), 1e-4);
}

TEST(OneWay, WithoutPressureGradientThereIsNoBuoyancy) {
  const double v = velocity_after({.two_way = false, .pressure_gradient = false}, long_step, 30);
  EXPECT_NEAR(upflow - v, terminal_slip(0), 1e-9);
  EXPECT_GT(terminal_slip(0) - terminal_slip(gas_density), 1e-4); // which shows at this tolerance
}

TEST(OneWay, WithoutDragItFalls) {
  const double v = velocity_after({.two_way = false, .drag = false}, 1e-4, 20);
  EXPECT_NEAR(v, -g * (1 - gas_density / solid_density) * 2e-3, 1e-10);
}

TEST(OneWay, WithNeitherItIsLeftAlone) {
  const double v =
      velocity_after({.two_way = false, .drag = false, .pressure_gradient = false}, 1e-4, 20);
  EXPECT_NEAR(v, -g * 2e-3, 1e-14);
}

TEST(TwoWays, BooksCloseWithPartsOff) {
  for (const bool drag : {false, true})
    for (const bool pressure : {false, true}) {
      coupling::ExchangeReport report;
      velocity_after({.drag = drag, .pressure_gradient = pressure}, 1e-3, 15, &report);
      EXPECT_LT(report.void_fraction_min, 1);
      EXPECT_LT(report.momentum_residual, 1e-12) << drag << pressure;
      EXPECT_LT(report.budget_residual, 1e-9);
      EXPECT_EQ(norm(report.impulse_to_particles) > 0, drag || pressure);
    }
}

TEST(TwoWays, BooksCloseWhenTheLastOneLeaves) {
  for (const bool pressure : {false, true}) {
    coupling::ExchangeReport report;
    velocity_after({.drag = false, .pressure_gradient = pressure}, 1e-3, 40, &report);
    EXPECT_EQ(report.particles, 0);
    EXPECT_EQ(report.void_fraction_min, 1);
    EXPECT_LT(report.momentum_residual, 1e-12);
  }
}

} // namespace
