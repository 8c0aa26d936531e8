// SPDX-FileCopyrightText: 2026 The GranFlux developers
// SPDX-License-Identifier: BSD-3-Clause

// Parcels of k^3 particles, k times as large: drag, heat and void fraction are those of the
// particles they stand for. A parcel held in a stream of air in a box of slip walls, in a cell so
// large that the stream does not feel it; closed forms of Schiller and Naumann, and of Ranz and
// Marshall, for one particle.

#include <cmath>
#include <gtest/gtest.h>
#include <numbers>

#include <granflux/cfd/error.hpp>

#include "warm_bed.hpp"

namespace {

using namespace granflux;
using granflux::testing::FakeHost;
using granflux::testing::WarmBed;

constexpr double diameter = 1e-4; // of the particles that the parcels stand for [m]
constexpr double density = 1.2, viscosity = 1.8e-5, speed = 0.4;
constexpr double conductivity = 0.026, capacity = 1000, gas_temperature = 350;
constexpr double solid_capacity = 900, solid_temperature = 300;
constexpr double interval = 1e-6; // s; so short that a temperature stays as it is
constexpr double reynolds = density * speed * diameter / viscosity;

double drag_of_one() {
  const double pi = std::numbers::pi;
  return 3 * pi * viscosity * diameter * speed * (1 + 0.15 * std::pow(reynolds, 0.687));
}

double conductance_of_one() {
  const double prandtl = viscosity * capacity / conductivity;
  const double nusselt = 2 + 0.6 * std::sqrt(reynolds) * std::cbrt(prandtl);
  return std::numbers::pi * diameter * conductivity * nusselt;
}

struct Taken {
  double force = 0;       ///< along the stream [N]
  double conductance = 0; ///< W/K
  double reynolds = 0, volume = 0;
};

/// By one parcel of coarse graining k, with heat by Ranz and Marshall or a given coefficient.
Taken taken(double k, double coefficient = 0, double told = 0) {
  const double size = 1e4 * diameter;
  cfd::GasCase c;
  for (auto& nodes : box_grid(c).nodes)
    nodes = cfd::uniform_nodes(0, 4 * size, 4);
  box_grid(c).periodic = {true, true, true};
  c.fluid = {.density = density, .viscosity = viscosity};
  c.initial_velocity = {0, speed, 0};
  c.energy = cfd::Energy{.heat_capacity = capacity,
                         .conductivity = conductivity,
                         .initial_temperature = gas_temperature};
  coupling::CouplingOptions options;
  options.drag = "schiller_naumann";
  options.nusselt = "ranz_marshall";
  options.heat_transfer_coefficient = coefficient;
  options.coarse_graining = told > 0 ? told : k;
  coupling::Coupler coupler(c, options, MPI_COMM_WORLD);
  FakeHost host({0, 0, 0}, {4 * size, 4 * size, 4 * size}, {true, true, true}, MPI_COMM_WORLD);
  host.add(granflux::testing::sphere(1, {1.5 * size, 1.5 * size, 1.5 * size}, {}, k * diameter / 2,
                                     2000, true));
  WarmBed bed(host, solid_capacity, solid_temperature);
  coupler.initialise(bed.view(), 0);
  coupler.exchange(bed.view(), interval);
  return {.force = coupler.report().drag.y,
          .conductance = coupler.report().heat_rate / (gas_temperature - solid_temperature),
          .reynolds = coupler.report().slip_reynolds_max,
          .volume = coupler.report().particle_volume};
}

TEST(Parcels, TakeTheDragAndHeatOfTheirParticles) {
  for (const double k : {1., 2., 3.5}) {
    const double particles = k * k * k;
    const Taken parcel = taken(k);
    EXPECT_NEAR(parcel.force / (particles * drag_of_one()), 1, 1e-5) << k;
    EXPECT_NEAR(parcel.conductance / (particles * conductance_of_one()), 1, 1e-4) << k;
    EXPECT_NEAR(parcel.reynolds / reynolds, 1, 1e-5) << k;
    const double volume = particles * std::numbers::pi / 6 * std::pow(diameter, 3);
    EXPECT_NEAR(parcel.volume / volume, 1, 1e-12) << k;
  }
}

TEST(Parcels, TakeHeatThroughTheSurfaceOfTheirParticles) {
  const double one = std::numbers::pi * diameter * diameter * 50;
  EXPECT_NEAR(taken(3, 50).conductance / (27 * one), 1, 1e-4);
}

TEST(Parcels, NoticesAFactorThatIsFivePercentOff) {
  EXPECT_GT(std::abs(taken(2, 0, 2.1).force / (8 * drag_of_one()) - 1), 0.05);
}

TEST(Parcels, AreNeverSmallerThanTheirParticles) {
  EXPECT_THROW(taken(0.5), ConfigError);
}

} // namespace
