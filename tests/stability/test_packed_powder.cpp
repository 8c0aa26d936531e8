// SPDX-FileCopyrightText: 2026 The GranFlux developers
// SPDX-License-Identifier: BSD-3-Clause

// A packed cube of cracking catalyst, 75 um and 1500 kg/m3, in air. The gas gives up its momentum
// to the particles in 1.7e-6 s: drag that is explicit in the gas is unstable beyond twice that. The
// pressure drop is Ergun's at any step; so it is at close packing, at Reynolds numbers beyond any
// law's range, and after an inlet that opens within one step.

#include <cmath>
#include <gtest/gtest.h>

#include <granflux/cfd/error.hpp>

#include "duct.hpp"

namespace {

using namespace granflux;
using namespace granflux::testing;

constexpr double d = 75e-6, solid_density = 1500, density = 1.2, viscosity = 1.8e-5;
constexpr double packed = 0.45;        // void fraction
constexpr double slow = 0.05 * packed; // superficial velocity [m/s]
constexpr cfd::Index3 cells{4, 4, 6};

struct Bed {
  double velocity = slow; ///< superficial [m/s]
  double step = 1e-4;     ///< of coupling [s]
  double void_fraction = packed;
  double viscosity = ::viscosity;
  const char* kernel = "trilinear";
  bool springs = false;  ///< particles are held by stiff springs, as contacts do, or by decree
  bool sudden = false;   ///< the inlet opens within the first step
  double stickiness = 1; ///< factor of the drag
};

struct Outcome {
  double drop = 0;   ///< over Ergun's, at the end
  double peak = 0;   ///< largest of all steps
  double second = 0; ///< at the second step
  coupling::ExchangeReport report;
};

constexpr int per_cell = 3;

double length(const Bed& bed) {
  return cells[2] * per_cell * lattice_constant(d, bed.void_fraction);
}

Outcome blow(const Bed& bed, int steps = 30) {
  const double a = lattice_constant(d, bed.void_fraction), cell = per_cell * a;
  cfd::GasCase c = upright_duct(cells, {cell, cell, cell}, bed.velocity);
  c.fluid = {.density = density, .viscosity = bed.viscosity * bed.stickiness};
  c.numerics.pressure_tolerance = c.numerics.viscous_tolerance = 1e-13;
  if (bed.sudden)
    c.boundaries[0].ramp_time = bed.step;
  coupling::CouplingOptions options;
  options.drag = "ergun";
  options.void_fraction = bed.kernel;
  coupling::Coupler coupler(c, options, MPI_COMM_WORLD);
  FakeHost host({0, 0, 0}, {cells[0] * cell, cells[1] * cell, cells[2] * cell}, {true, true, false},
                MPI_COMM_WORLD);
  add_lattice(host, {cells[0] * per_cell, cells[1] * per_cell, cells[2] * per_cell}, a, d,
              solid_density, !bed.springs);
  const std::vector<Vec3> home = host.position;
  const int every = bed.springs ? 20 : 1;
  const double dt = bed.step / every, frequency = 0.3 / dt; // critically damped
  if (bed.springs)
    host.other_force = [&](const Particle& q) {
      const Vec3 displaced = q.position - home[std::size_t(q.id - 1)];
      return -q.mass * frequency * (frequency * displaced + 2 * q.velocity);
    };
  coupler.initialise(host.view(), 0);
  const double exact =
      length(bed) * ergun(bed.void_fraction, d, density, bed.viscosity, bed.velocity);
  Outcome outcome;
  for (int step = 0; step < steps; ++step) {
    for (int part = 0; part < every; ++part)
      host.step(coupler, dt, part == 0, bed.step);
    outcome.drop = pressure_drop(coupler) / exact;
    outcome.peak = std::max(outcome.peak, std::abs(outcome.drop));
    if (step == 1)
      outcome.second = outcome.drop;
  }
  outcome.report = coupler.report();
  EXPECT_LT(outcome.report.volume_residual, 1e-12);
  EXPECT_LT(outcome.report.momentum_residual, 1e-12);
  EXPECT_LT(outcome.report.budget_residual, 1e-10);
  return outcome;
}

/// The same bed with drag as a source that follows the gas one step late. Largest pressure drop
/// over Ergun's; infinite where the gas stops being a number.
double explicit_drag(double dt) {
  const double a = lattice_constant(d, packed), cell = per_cell * a;
  const double beta = packed * packed * ergun(packed, d, density, viscosity, slow) / slow;
  cfd::GasCase c = upright_duct(cells, {cell, cell, cell}, slow);
  c.fluid = {.density = density, .viscosity = viscosity};
  const cfd::Mesh mesh = cfd::make_mesh(c, MPI_COMM_WORLD);
  cfd::GasSolver gas(mesh, c);
  const cfd::BlockFields eps = cfd::make_fields(mesh, packed);
  cfd::MomentumExchange exchange = cfd::make_exchange(mesh);
  exchange.pressure_fraction = eps;
  gas.initialise(eps, Vec3{0, 0, slow / packed});
  double peak = 0;
  try {
    for (int step = 0; step < 60; ++step) {
      for (std::size_t b = 0; b < mesh.local.size(); ++b)
        for (std::size_t m = 0; m < 3; ++m)
          cfd::for_cells(mesh.local[b].layout, [&](std::ptrdiff_t p) {
            exchange.drag_source[b][m][p] = -beta * gas.velocity()[b][m][p];
          });
      gas.advance(dt, eps, &exchange);
      peak = std::max(peak, std::abs(gas.boundary_pressure("in") - gas.boundary_pressure("out")));
    }
  } catch (const NumericalError&) {
    return HUGE_VAL;
  }
  return peak / (ergun(packed, d, density, viscosity, slow) * cells[2] * cell);
}

TEST(PackedPowder, ExplicitDragBlowsUpBeyondItsLimit) {
  EXPECT_NEAR(explicit_drag(3e-6), 1, 1e-3); // the limit is 2 eps rho / beta = 3.34e-6 s
  EXPECT_GT(explicit_drag(1e-5), 1e6);
  EXPECT_GT(explicit_drag(1e-4), 1e6);
}

TEST(PackedPowder, PressureDropIsErgunsAtAnyStep) {
  for (const double step : {1e-6, 1e-5, 1e-4, 1e-3, 1e-2}) {
    const Outcome outcome = blow({.step = step});
    EXPECT_NEAR(outcome.drop, 1, 1e-9) << step;
    EXPECT_LT(outcome.peak, 1 + 1e-6) << step;
  }
  EXPECT_GT(blow({.stickiness = 1.05}).drop, 1.04); // 5 % more drag is seen
}

TEST(PackedPowder, SoItIsWhereContactsHoldTheParticles) {
  for (const auto& [step, error] : {std::pair{1e-4, 1e-3}, std::pair{1e-3, 1e-3}}) {
    const Outcome outcome = blow({.step = step, .springs = true});
    EXPECT_NEAR(outcome.drop, 1, error) << step;
    EXPECT_LT(outcome.peak, 1 + error) << step;
  }
}

// Simple cubic packing of spheres that touch, 0.4764, and the void fraction of the closest one.
TEST(PackedPowder, ClosePackingIsErgunsToo) {
  for (const char* kernel : {"centre", "divided", "trilinear", "spline", "smoothed"})
    for (const double void_fraction : {0.4764, 0.2595}) {
      const Outcome outcome = blow({.void_fraction = void_fraction, .kernel = kernel});
      EXPECT_NEAR(outcome.drop, 1, 1e-9) << kernel << ' ' << void_fraction;
      EXPECT_NEAR(outcome.report.void_fraction_min, void_fraction, 1e-9) << kernel;
    }
}

TEST(PackedPowder, VeryHighReynoldsNumbersAreFiniteAndSaidToBeOutOfRange) {
  for (const double velocity : {10., 1000.}) { // Re 9e5 and 9e7
    const double step = 0.1 * per_cell * d / velocity;
    const Outcome outcome = blow({.velocity = velocity, .step = step, .viscosity = 1e-9});
    EXPECT_NEAR(outcome.drop, 1, 1e-9);
    EXPECT_GT(outcome.report.slip_reynolds_max, 8e5);
    EXPECT_GT(outcome.report.law_out_of_range, 0);
  }
}

TEST(PackedPowder, SuddenInletPushesOnceAndIsAtThePlateau) {
  for (const bool springs : {false, true})
    for (const double step : {1e-4, 1e-5}) {
      const Bed bed{.step = step, .springs = springs, .sudden = true};
      const Outcome outcome = blow(bed);
      // What sets the gas in motion within one step: rho L (U / eps) / dt.
      const double push = density * slow / bed.void_fraction / step /
                          ergun(bed.void_fraction, d, density, viscosity, slow);
      EXPECT_LT(outcome.peak, 1.01 * (1 + push));
      EXPECT_GT(outcome.peak, step < 5e-5 ? 1 + 0.9 * push : 1); // it was sudden
      EXPECT_NEAR(outcome.second, 1, 0.01);
      EXPECT_NEAR(outcome.drop, 1, 1e-3);
    }
}

} // namespace
