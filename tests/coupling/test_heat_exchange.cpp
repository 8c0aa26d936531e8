// SPDX-FileCopyrightText: 2026 The GranFlux developers
// SPDX-License-Identifier: BSD-3-Clause

// Gas and particles of a periodic box relax to one temperature:
//   eps rho c dT/dt = h a (T_s - T),  (1 - eps) rho_s c_s dT_s/dt = h a (T - T_s),
// a = 6 (1 - eps) / d. Both end at the mean by heat capacity.

#include <cmath>
#include <gtest/gtest.h>
#include <numbers>

#include <granflux/cfd/sweep.hpp>

#include "warm_bed.hpp"

namespace {

using namespace granflux;
using granflux::testing::FakeHost;
using granflux::testing::WarmBed;

constexpr int cells = 4, per_cell = 2;
constexpr double void_fraction = 0.6, cold = 300, hot = 600; // gas and particles at the start [K]
constexpr double gas_density = 1.2, gas_capacity = 1000, solid_density = 1000, solid_capacity = 900;
constexpr double gas_heat = void_fraction * gas_density * gas_capacity; // J/(m3 K)
constexpr double solid_heat = (1 - void_fraction) * solid_density * solid_capacity;
constexpr double final_temperature = (gas_heat * cold + solid_heat * hot) / (gas_heat + solid_heat);

struct Box {
  Box(double diameter, double coefficient, const char* kernel = "trilinear")
      : d(diameter), spacing(d * std::cbrt(std::numbers::pi / 6 / (1 - void_fraction))),
        size(cells * per_cell * spacing),
        coupler(make_case(), make_options(coefficient, kernel), MPI_COMM_WORLD),
        host({0, 0, 0}, {size, size, size}, {true, true, true}, MPI_COMM_WORLD) {
    const int n = cells * per_cell;
    for (int p = 0; p < n * n * n; ++p)
      host.add(granflux::testing::sphere(
          p, {(p % n + 0.5) * spacing, (p / n % n + 0.5) * spacing, (p / (n * n) + 0.5) * spacing},
          {}, d / 2, solid_density, true));
  }

  [[nodiscard]] cfd::GasCase make_case() const {
    cfd::GasCase c;
    for (auto& nodes : box_grid(c).nodes)
      nodes = cfd::uniform_nodes(0, size, cells);
    box_grid(c).periodic = {true, true, true};
    c.fluid.density = gas_density;
    c.energy = cfd::Energy{
        .heat_capacity = gas_capacity, .conductivity = 0.026, .initial_temperature = cold};
    c.numerics.pressure_tolerance = c.numerics.viscous_tolerance = 1e-14;
    return c;
  }
  static coupling::CouplingOptions make_options(double coefficient, const char* kernel) {
    coupling::CouplingOptions options;
    options.void_fraction = kernel;
    options.heat_transfer_coefficient = coefficient;
    return options;
  }

  [[nodiscard]] double gas_heat_content() {
    double heat = 0;
    const auto& mesh = coupler.mesh();
    for (std::size_t b = 0; b < mesh.local.size(); ++b)
      cfd::for_cells(mesh.local[b].layout, [&](std::ptrdiff_t c) {
        heat += mesh.local[b].volume[c] * gas_heat * (*coupler.gas().temperature())[b][c];
      });
    return heat;
  }
  [[nodiscard]] double total(double mine) const {
    MPI_Allreduce(MPI_IN_PLACE, &mine, 1, MPI_DOUBLE, MPI_SUM, MPI_COMM_WORLD);
    return mine;
  }

  double d, spacing, size;
  coupling::Coupler coupler;
  FakeHost host;
};

TEST(HeatExchange, IsMonotoneAndConservesHeatHoweverStiff) {
  for (const double stiffness : {0.1, 1., 10., 100., 1000.}) {
    Box box(1e-3, 50);
    const double rate = 50 * 6 * (1 - void_fraction) / box.d * (1 / gas_heat + 1 / solid_heat);
    WarmBed bed(box.host, solid_capacity, hot);
    box.coupler.initialise(bed.view(), 0);
    const double volume = box.size * box.size * box.size;
    const double initial = volume * (gas_heat * cold + solid_heat * hot);
    double gas = cold, solid = hot;
    for (int step = 0; step < (stiffness < 1 ? 300 : 60); ++step) {
      bed.step(box.coupler, stiffness / rate, 3);
      const double gas_content = box.total(box.gas_heat_content());
      const double solid_content = box.total(bed.heat());
      EXPECT_NEAR((gas_content + solid_content) / initial, 1, 1e-13);
      const double next_gas = gas_content / volume / gas_heat;
      const double next_solid = solid_content / volume / solid_heat;
      // They approach each other and do not cross.
      EXPECT_GE(next_gas, gas - 1e-10);
      EXPECT_LE(next_solid, solid + 1e-10);
      EXPECT_LE(next_gas, next_solid + 1e-10);
      gas = next_gas, solid = next_solid;
      // Against heats exchanged of a thousandth of what the solids hold, to their rounding.
      EXPECT_LT(box.coupler.report().heat_residual, 1e-10);
    }
    EXPECT_NEAR(gas, final_temperature, 1e-9) << stiffness;
    EXPECT_NEAR(solid, final_temperature, 1e-9) << stiffness;
  }
}

// The same by explicit steps: the difference is multiplied by 1 - dt rate.
TEST(HeatExchange, ExplicitExchangeLeavesTheBounds) {
  for (const double stiffness : {10., 100., 1000.}) {
    double gas = cold, solid = hot;
    for (int step = 0; step < 20; ++step) {
      const double heat = stiffness * (solid - gas) / (1 / gas_heat + 1 / solid_heat); // J/m3
      gas += heat / gas_heat;
      solid -= heat / solid_heat;
    }
    EXPECT_GT(std::abs(gas), 1e15) << stiffness;
  }
}

TEST(HeatExchange, RateConvergesToTheClosedForm) {
  const auto difference = [](int steps, double coefficient) {
    Box box(1e-3, coefficient);
    WarmBed bed(box.host, solid_capacity, hot);
    box.coupler.initialise(bed.view(), 0);
    const double rate = 50 * 6 * (1 - void_fraction) / box.d * (1 / gas_heat + 1 / solid_heat);
    for (int step = 0; step < steps; ++step)
      bed.step(box.coupler, 1 / rate / steps, 2);
    const double volume = box.size * box.size * box.size;
    return (box.total(bed.heat()) / solid_heat - box.total(box.gas_heat_content()) / gas_heat) /
           volume / (hot - cold);
  };
  const double exact = std::exp(-1.);
  const double coarse = difference(20, 50), fine = difference(40, 50);
  EXPECT_NEAR(std::log2((coarse - exact) / (fine - exact)), 1, 0.1);
  const double limit = 2 * fine - coarse;
  EXPECT_NEAR(limit, exact, 1e-3 * exact);
  // 5 % more heat transfer would show.
  EXPECT_GT(exact - (2 * difference(40, 52.5) - difference(20, 52.5)), 0.04 * exact);
}

// 20 um in gas by Gunn's law, steps of 1000 times the time in which a particle takes the gas's
// temperature and 1e6 times that of the gas.
TEST(HeatExchange, StiffestDust) {
  Box box(20e-6, 0);
  WarmBed bed(box.host, solid_capacity, hot);
  box.coupler.initialise(bed.view(), 0);
  const double nusselt = 7 - 10 * void_fraction + 5 * void_fraction * void_fraction;
  const double time = solid_density * solid_capacity * box.d * box.d / (6 * nusselt * 0.026);
  for (int step = 0; step < 12; ++step) {
    bed.step(box.coupler, 1000 * time, 1);
    EXPECT_NEAR(box.coupler.report().heat_stiffness_max, 1000, 1e-6);
    for (const double temperature : bed.temperature()) {
      EXPECT_LE(temperature, hot);
      EXPECT_GE(temperature, cold);
    }
  }
  for (const double temperature : bed.temperature())
    EXPECT_NEAR(temperature, final_temperature, 1e-9);
}

// With other heat between two coupling steps the particles receive less than was booked; the rest
// goes back to the gas.
TEST(HeatExchange, WhatIsNotTakenIsHandedBack) {
  Box box(1e-3, 200, "smoothed");
  WarmBed bed(box.host, solid_capacity, hot);
  box.coupler.initialise(bed.view(), 0);
  const double volume = box.size * box.size * box.size;
  double total = volume * (gas_heat * cold + solid_heat * hot);
  constexpr double interval = 0.01, power = 0.02; // W on every particle
  const double all = box.total(double(box.host.size())) * power;
  for (int step = 0; step < 50; ++step) {
    bed.step(box.coupler, interval, 4, [](std::size_t) { return power; });
    total += interval * all;
    const auto& report = box.coupler.report();
    const double known = box.total(box.gas_heat_content() + bed.heat());
    // Until the next coupling step the difference is under way.
    EXPECT_LT(report.heat_residual, 1e-12);
    EXPECT_LT(std::abs(known - total), 2 * interval * all);
    EXPECT_GT(std::abs(known - total), 1e-9 * interval * all);
  }
  EXPECT_GT(box.total(bed.heat()) / volume / solid_heat, final_temperature);
}

/// Temperature of an alumina sphere of 2 mm, 373 K at first, after seconds in gas of 298 K that
/// passes it at Re = 100, Pr = 0.7; the box is so large that the gas stays as it is.
double cooled(const char* law, double seconds) {
  constexpr double d = 2e-3, k = 0.026, cp = 1006, mu = 0.7 * k / cp, rho = 1.2;
  cfd::GasCase c;
  for (auto& nodes : box_grid(c).nodes)
    nodes = cfd::uniform_nodes(0, 4, 4);
  box_grid(c).periodic = {true, true, true};
  c.fluid = {.density = rho, .viscosity = mu};
  c.energy = cfd::Energy{.heat_capacity = cp, .conductivity = k, .initial_temperature = 298};
  c.initial_velocity = {0, 0, 100 * mu / (rho * d)};
  coupling::CouplingOptions options;
  options.void_fraction = "centre";
  options.nusselt = law;
  coupling::Coupler coupler(c, options, MPI_COMM_WORLD);
  FakeHost host({0, 0, 0}, {4, 4, 4}, {true, true, true}, MPI_COMM_WORLD);
  host.add(granflux::testing::sphere(1, {1.5, 1.5, 1.5}, {}, d / 2, 3900, true));
  WarmBed bed(host, 875, 373);
  coupler.initialise(bed.view(), 0);
  for (int step = 0; step < int(2 * seconds); ++step)
    bed.step(coupler, 0.5, 1);
  double temperature = bed.temperature().empty() ? 0 : bed.temperature()[0];
  MPI_Allreduce(MPI_IN_PLACE, &temperature, 1, MPI_DOUBLE, MPI_SUM, MPI_COMM_WORLD);
  return temperature;
}

TEST(LumpedCooling, PublishedTemperaturesByGunn) {
  for (const auto& [seconds, temperature] :
       {std::pair(1., 366.4299), {5., 345.4225}, {10., 327.9852}, {20., 309.9882}})
    EXPECT_NEAR(cooled("gunn", seconds), temperature, 0.01) << seconds;
}

// The rate is 6 h / (rho c d), with Nu of the laws' sources worked out apart (Li and Mason's is
// Ranz and Marshall's for a single sphere).
TEST(LumpedCooling, EveryLaw) {
  const double root = std::cbrt(0.7);
  const std::pair<const char*, double> laws[] = {{"gunn", 8.02185},
                                                 {"ranz_marshall", 7.32742},
                                                 {"wakao", 2 + 1.1 * std::pow(10, 1.2) * root},
                                                 {"li_mason", 7.32742}};
  for (const auto& [law, nusselt] : laws) {
    const double rate = 6 * nusselt * 0.026 / (3900 * 875 * 2e-3 * 2e-3);
    EXPECT_NEAR(cooled(law, 10), 298 + 75 * std::exp(-10 * rate), 0.01) << law;
    EXPECT_GT(std::abs(cooled(law, 10) - 298 - 75 * std::exp(-10.5 * rate)), 0.5) << law;
  }
}

TEST(HeatExchange, AskForTemperatures) {
  Box box(1e-3, 50);
  EXPECT_THROW(box.coupler.initialise(box.host.view(), 0), ConfigError);
}

} // namespace
