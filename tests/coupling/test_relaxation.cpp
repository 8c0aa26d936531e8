// SPDX-FileCopyrightText: 2026 The GranFlux developers
// SPDX-License-Identifier: BSD-3-Clause

// Gas and particles of a periodic box relax to one velocity:
//   eps rho du/dt = beta (v - u),  (1 - eps) rho_p dv/dt = beta (u - v)
// with eps 0.6, rho 1.2, rho_p 1000 kg/m3, beta 1000 kg/(m3 s), u(0) = 1 m/s, v(0) = 0. Closed
// form: slip decays at 1391.39 1/s, both end at 0.72 / 400.72 = 0.00179677 m/s.

#include <cmath>
#include <gtest/gtest.h>
#include <numbers>

#include "fake_host.hpp"

namespace {

using namespace granflux;

constexpr double rate = 1000 / 0.72 + 1000 / 400.; // 1/s
constexpr double final_velocity = 0.72 / 400.72;   // m/s
constexpr int cells = 4, per_cell = 2;
constexpr double cell_size = 1; // mm would do as well: nothing here has a length

cfd::GasCase make_case(double d) {
  cfd::GasCase c;
  for (auto& nodes : box_grid(c).nodes)
    nodes = cfd::uniform_nodes(0, cells * cell_size, cells);
  box_grid(c).periodic = {true, true, true};
  c.fluid.density = 1.2;
  c.fluid.viscosity = 1000 * d * d / (18 * 0.6 * 0.4); // Stokes' beta = 18 mu eps (1-eps) / d^2
  c.initial_velocity = {0, 0, 1};
  c.numerics.pressure_tolerance = 1e-14;
  c.numerics.viscous_tolerance = 1e-14;
  return c;
}

struct Relaxation {
  std::vector<double> gas, solid; ///< mean velocities after each step [m/s]
  double momentum_error = 0;      ///< largest, relative to the initial momentum
};

Relaxation relax(double dt, int steps) {
  const double volume = 0.4 * std::pow(cell_size / per_cell, 3);
  const double radius = std::cbrt(volume * 3 / (4 * std::numbers::pi));
  const cfd::GasCase c = make_case(2 * radius);
  coupling::CouplingOptions options;
  options.drag = "stokes";
  options.void_fraction = "trilinear";
  coupling::Coupler coupler(c, options, MPI_COMM_WORLD);
  const double size = cells * cell_size;
  granflux::testing::FakeHost host({0, 0, 0}, {size, size, size}, {true, true, true},
                                   MPI_COMM_WORLD);
  const int n = cells * per_cell;
  for (int p = 0; p < n * n * n; ++p) {
    const double a = cell_size / per_cell;
    host.add(granflux::testing::sphere(
        p, {(p % n + 0.5) * a, (p / n % n + 0.5) * a, (p / (n * n) + 0.5) * a}, {}, radius, 1000));
  }
  coupler.initialise(host.view(), 0);
  const double box = size * size * size;
  const double initial = 0.6 * 1.2 * box;
  Relaxation result;
  for (int s = 0; s < steps; ++s) {
    host.step(coupler, dt, true, dt);
    const double gas = coupler.gas().balance().momentum.z, solid = host.momentum().z;
    result.gas.push_back(gas / initial);
    result.solid.push_back(solid / (400 * box));
    result.momentum_error =
        std::max(result.momentum_error, std::abs(gas + solid - initial) / initial);
    EXPECT_LT(coupler.report().momentum_residual, 1e-12);
    EXPECT_LT(coupler.report().volume_residual, 1e-12);
    EXPECT_LT(coupler.report().budget_residual, 1e-10);
  }
  return result;
}

TEST(Relaxation, IsMonotoneAndConservesMomentumHoweverStiff) {
  for (const double stiffness : {0.1, 1., 10., 100., 1000.}) {
    const int steps = stiffness < 1 ? 300 : 40;
    const Relaxation r = relax(stiffness / rate, steps);
    EXPECT_LT(r.momentum_error, 1e-12) << "dt x rate " << stiffness;
    double slip = 1;
    for (std::size_t s = 0; s < r.gas.size(); ++s) {
      const double next = r.gas[s] - r.solid[s];
      EXPECT_LE(next, slip + 1e-14) << "dt x rate " << stiffness << ", step " << s;
      EXPECT_GE(next, -1e-14) << "dt x rate " << stiffness << ", step " << s;
      slip = next;
    }
    EXPECT_NEAR(r.gas.back(), final_velocity, 1e-9) << "dt x rate " << stiffness;
    EXPECT_NEAR(r.solid.back(), final_velocity, 1e-9) << "dt x rate " << stiffness;
  }
}

/// Slip after some explicit steps of the two equations: each multiplies it by 1 - dt rate.
double explicit_slip(double stiffness, int steps) {
  const double dt = stiffness / rate;
  double u = 1, v = 0;
  for (int s = 0; s < steps; ++s) {
    const double drag = 1000 * (u - v);
    u -= dt * drag / 0.72;
    v += dt * drag / 400;
  }
  return u - v;
}

TEST(Relaxation, ExplicitDragOvershootsBeyondOneAndBlowsUpBeyondTwo) {
  EXPECT_GT(explicit_slip(0.1, 1), 0);
  EXPECT_LT(explicit_slip(1.5, 1), 0);
  EXPECT_LT(std::abs(explicit_slip(1.5, 40)), 1e-9);
  for (const double stiffness : {10., 100., 1000.})
    EXPECT_GT(std::abs(explicit_slip(stiffness, 40)), 1e30) << stiffness;
}

TEST(Relaxation, RateConvergesToTheClosedForm) {
  // Slip after 1/rate; the gas is implicit Euler, so the error is of first order in dt.
  const auto slip = [](int steps) {
    const Relaxation r = relax(1 / rate / steps, steps);
    return r.gas.back() - r.solid.back();
  };
  const double exact = std::exp(-1.);
  const double coarse = slip(20) - exact, fine = slip(40) - exact;
  EXPECT_NEAR(std::log2(coarse / fine), 1, 0.1);
  EXPECT_NEAR(2 * fine - coarse, 0, 1e-3 * exact);
}

} // namespace
