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

using coupling::DragTreatment;

constexpr double gas_rate = 1000 / 0.72, solid_rate = 1000 / 400.; // 1/s
constexpr double rate = gas_rate + solid_rate;
constexpr double final_velocity = 0.72 / 400.72; // m/s
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
  std::vector<double> gas, solid;            ///< mean velocities after each step [m/s]
  double momentum_error = 0;                 ///< largest, relative to the initial momentum
  double gas_drag_number = 0, stiffness = 0; ///< of the last report

  [[nodiscard]] double slip(std::size_t step) const { return gas[step] - solid[step]; }
};

Relaxation relax(double dt, int steps, DragTreatment treatment = DragTreatment::implicit_in_both) {
  const double volume = 0.4 * std::pow(cell_size / per_cell, 3);
  const double radius = std::cbrt(volume * 3 / (4 * std::numbers::pi));
  const cfd::GasCase c = make_case(2 * radius);
  coupling::CouplingOptions options;
  options.drag = "stokes";
  options.void_fraction = "trilinear";
  options.drag_treatment = treatment;
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
    result.gas_drag_number = coupler.report().gas_drag_number_max;
    result.stiffness = coupler.report().stiffness_max;
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

/// What one step makes of the slip, with a = gas_rate dt and c = solid_rate dt.
double slip_factor(DragTreatment treatment, double dt) {
  const double a = gas_rate * dt, c = solid_rate * dt;
  return treatment == DragTreatment::explicit_in_both ? 1 - a - c : (1 - c) / (1 + a);
}

TEST(Relaxation, EachTreatmentIsItsDifferenceEquation) {
  for (const auto treatment : {DragTreatment::explicit_in_both, DragTreatment::implicit_in_gas})
    for (const double stiffness : {0.1, 0.5, 1., 1.5}) {
      const double dt = stiffness / rate, factor = slip_factor(treatment, dt);
      const Relaxation r = relax(dt, 6, treatment);
      EXPECT_LT(r.momentum_error, 1e-12) << "dt x rate " << stiffness;
      double slip = 1;
      for (std::size_t s = 0; s < r.gas.size(); ++s)
        EXPECT_NEAR(r.slip(s), slip *= factor, 1e-11) << "dt x rate " << stiffness << ", " << s;
    }
}

TEST(Relaxation, ExplicitDragBlowsUpBeyondTwo) {
  const auto treatment = DragTreatment::explicit_in_both;
  const Relaxation below = relax(1.9 / rate, 40, treatment);
  EXPECT_NEAR(std::abs(below.slip(39)), std::pow(0.9, 40), 1e-9);
  // The two numbers that the stable range adds up are what counts.
  EXPECT_NEAR(below.gas_drag_number, 1.9 * gas_rate / rate, 1e-10);
  EXPECT_NEAR(below.stiffness, 1.9 * solid_rate / rate, 1e-10);
  const Relaxation above = relax(2.2 / rate, 20, treatment);
  EXPECT_NEAR(above.slip(19), std::pow(1.2, 20), 1e-9);
  EXPECT_GT(above.slip(19), 38);
}

TEST(Relaxation, DragImplicitInTheGasBearsSuchSteps) {
  const Relaxation r = relax(100 / rate, 40, DragTreatment::implicit_in_gas);
  EXPECT_LT(std::abs(r.slip(39)), 1e-12);
  EXPECT_EQ(r.gas_drag_number, 0);
}

TEST(Relaxation, EachTreatmentConvergesToTheClosedForm) {
  // Slip after 1/rate; all are of first order in dt.
  for (const auto treatment : {DragTreatment::explicit_in_both, DragTreatment::implicit_in_gas,
                               DragTreatment::implicit_in_both}) {
    const auto slip = [&](int steps) {
      return relax(1 / rate / steps, steps, treatment).slip(std::size_t(steps - 1));
    };
    const double exact = std::exp(-1.);
    const double coarse = slip(20) - exact, fine = slip(40) - exact;
    EXPECT_NEAR(std::log2(coarse / fine), 1, 0.1) << int(treatment);
    EXPECT_NEAR(2 * fine - coarse, 0, 1e-3 * exact) << int(treatment);
  }
}

} // namespace
