// SPDX-FileCopyrightText: 2026 The GranFlux developers
// SPDX-License-Identifier: BSD-3-Clause

// A sphere of 100 um and 2000 kg/m3 in an upflow of air (1.2 kg/m3, 1.8e-5 Pa s) at 0.4 m/s: case
// DEM06 of MFiX 21.3, g = 9.80665 m/s2, drag of Schiller and Naumann. It falls at 0.05740169 m/s in
// the laboratory, a slip of 0.45740169 m/s (closed form, buoyancy included).

#include <cmath>
#include <gtest/gtest.h>

#include <granflux/cfd/error.hpp>

#include "fake_host.hpp"

namespace {

using namespace granflux;
using granflux::testing::FakeHost;
using granflux::testing::sphere;

constexpr double d = 100e-6, solid_density = 2000, g = 9.80665, upflow = 0.4;
constexpr double terminal_slip = 0.45740169; // m/s
constexpr double response_time = 0.0617;     // s, m/b at Re -> 0

/// Box of 5 x 20 x 5 cells of the given size with slip sides. `drag_factor` multiplies the drag:
/// at a fixed Re it is proportional to density and viscosity.
cfd::GasCase make_case(double cell, double drag_factor) {
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
  c.fluid = {
      .density = 1.2 * drag_factor, .viscosity = 1.8e-5 * drag_factor, .gravity = {0, -g, 0}};
  c.initial_velocity = {0, upflow, 0};
  return c;
}

struct Fall {
  double slip = 0;    ///< of the undisturbed upflow at the end [m/s]
  double fastest = 0; ///< largest on the way
};

/// Lets the particle go at rest in a grid of cells of `cell_diameters` particle diameters.
Fall fall(double cell_diameters, double dt, int every, double duration, double drag_factor = 1) {
  const double cell = cell_diameters * d;
  coupling::CouplingOptions options;
  options.drag = "schiller_naumann";
  options.void_fraction = "trilinear";
  coupling::Coupler coupler(make_case(cell, drag_factor), options, MPI_COMM_WORLD);
  FakeHost host({0, 0, 0}, {5 * cell, 20 * cell, 5 * cell}, {}, MPI_COMM_WORLD);
  host.gravity = {0, -g, 0};
  host.add(sphere(1, {2.3 * cell, 10.4 * cell, 2.7 * cell}, {}, d / 2, solid_density));
  coupler.initialise(host.view(), 0);
  const double mass = solid_density * granflux::testing::sphere_volume(d / 2);
  Fall result;
  const int steps = int(std::ceil(duration / dt));
  for (int s = 0; s < steps; ++s) {
    host.step(coupler, dt, s % every == 0, every * dt);
    result.slip = upflow - host.momentum().y / mass;
    result.fastest = std::max(result.fastest, result.slip);
    if (s % every == 0) {
      EXPECT_LT(coupler.report().momentum_residual, 1e-12);
      EXPECT_LT(coupler.report().volume_residual, 1e-12);
    }
  }
  return result;
}

// Cells of 1e5 diameters: the gas does not feel the particle, the coupling is one-way.
constexpr double one_way = 1e5;

TEST(TerminalVelocity, OneWayIsExactHoweverStiff) {
  for (const double stiffness : {0.01, 0.1, 1., 10., 100., 1000.}) {
    const double dt = stiffness * response_time;
    // Longer steps in larger cells: the gas has its Courant number.
    const double cell = stiffness > 100 ? 10 * one_way : one_way;
    const Fall end = fall(cell, dt, 1, std::max(20 * response_time, 20 * dt));
    EXPECT_NEAR(end.slip, terminal_slip, 1e-4 * terminal_slip) << "dt/tau " << stiffness;
  }
}

/// Slip after 30 explicit steps from rest, m dv/dt = m g' - b(slip) slip.
double explicit_slip(double stiffness) {
  const double dt = stiffness * response_time, buoyant = g * (1 - 1.2 / solid_density);
  double slip = upflow;
  for (int s = 0; s < 30; ++s) {
    const double re = 1.2 * std::abs(slip) * d / 1.8e-5;
    slip += dt * (buoyant - slip / response_time * (1 + 0.15 * std::pow(re, 0.687)));
  }
  return slip;
}

TEST(TerminalVelocity, ExplicitDragBlowsUp) {
  EXPECT_NEAR(explicit_slip(0.5), terminal_slip, 1e-3);
  for (const double stiffness : {10., 100., 1000.})
    EXPECT_FALSE(std::abs(explicit_slip(stiffness)) < 1e6) << stiffness; // or not a number
}

TEST(TerminalVelocity, OneWayIsExactAtSmallSteps) {
  const double dt = 1e-3 * response_time;
  const Fall end = fall(one_way, dt, 10, 12 * response_time);
  EXPECT_NEAR(end.slip, terminal_slip, 1e-4 * terminal_slip);
}

TEST(TerminalVelocity, OneWayApproachDoesNotOvershoot) {
  // The coefficient is that of the slip at the start of an interval. Where the interval is short
  // that cannot carry the particle past its end; where it is longer than the response time, the
  // first guess is off by what the coefficient changes on the way: (0.4574/0.4)^0.17 - 1 = 2.3 %.
  for (const double stiffness : {0.1, 1.})
    EXPECT_LT(fall(one_way, stiffness * response_time, 1, 30 * response_time).fastest,
              terminal_slip * (1 + 1e-4))
        << "dt/tau " << stiffness;
  for (const double stiffness : {10., 100.})
    EXPECT_LT(fall(one_way, stiffness * response_time, 1, 3000 * response_time).fastest,
              terminal_slip * 1.025)
        << "dt/tau " << stiffness;
}

TEST(TerminalVelocity, OneWayFollowsThePublishedFall) {
  // Velocity after 0.01 ... 0.2 s, published with the case. The interval's coefficient lags.
  const double dt = 1e-4;
  for (const auto& [time, velocity] :
       {std::pair{0.05, -0.04078891}, std::pair{0.1, -0.05263133}, std::pair{0.2, -0.05701037}})
    EXPECT_NEAR(upflow - fall(one_way, dt, 1, time - 1e-9).slip, velocity, 1e-3 * 0.0574)
        << time << " s";
}

TEST(TerminalVelocity, TwoWayWithSmallParticlesIsWithinOnePercent) {
  const Fall end = fall(50, 1e-3, 1, 0.5); // d/dx 0.02
  EXPECT_NEAR(end.slip, terminal_slip, 0.01 * terminal_slip);
}

TEST(TerminalVelocity, NoticesFivePercentMoreDrag) {
  const double dt = 0.1 * response_time;
  const Fall end = fall(one_way, dt, 1, 20 * response_time, 1.05);
  EXPECT_GT(std::abs(end.slip - terminal_slip), 100 * 1e-4 * terminal_slip);
  const Fall two_way = fall(50, 1e-3, 1, 0.5, 1.05);
  EXPECT_GT(std::abs(two_way.slip - terminal_slip), 0.01 * terminal_slip);
}

} // namespace
