// SPDX-FileCopyrightText: 2026 The GranFlux developers
// SPDX-License-Identifier: GPL-2.0-or-later

#include "temperature_step.hpp"

#include <algorithm>

#include <granflux/coupling/heat_kick.hpp>

namespace granflux::particle_subset {

HeatPowers& HeatPowers::operator+=(const HeatPowers& o) & {
  conduction += o.conduction;
  walls += o.walls;
  made += o.made;
  convection += o.convection;
  source += o.source;
  to_walls += o.to_walls;
  held += o.held;
  return *this;
}

namespace {

template <bool with_walls, bool with_gas>
HeatPowers step(const HeatedParticles& p, std::span<const double> capacity, int held, double dt,
                Range range) {
  HeatPowers sum;
  for (int i = range.begin; i < range.end; ++i) {
    const HeatRates& rates = p.contacts[i];
    const double mc = p.mass[i] * capacity[std::size_t(p.type[i]) - 1];
    const bool is_held = (p.groups[i] & held) != 0;
    double received = rates.conduction + rates.made;
    if constexpr (with_walls) {
      received += p.walls[i].conduction;
      sum.walls += p.walls[i].conduction;
      sum.to_walls += p.walls[i].to_wall;
    }
    if constexpr (with_gas) {
      const double convection = coupling::convected_heat(p.gas[i], p.temperature[i],
                                                         received + p.source[i], mc, is_held, dt);
      received += convection;
      sum.convection += convection;
    }
    p.heat_flux[i] = received;
    const double total = received + p.source[i];
    sum.conduction += rates.conduction;
    sum.made += rates.made;
    sum.source += p.source[i];
    if (is_held) {
      sum.held += total;
      continue;
    }
    // What the sum rounds off is kept: steps of 1e-6 s warm by less than the last digit.
    const double change = dt * total / mc + p.carry[i];
    const double warmer = p.temperature[i] + change;
    p.carry[i] = change - (warmer - p.temperature[i]);
    p.temperature[i] = warmer;
  }
  return sum;
}

} // namespace

DetailSums& DetailSums::operator+=(const DetailSums& o) & {
  friction += o.friction;
  damping += o.damping;
  conduction_number = std::max(conduction_number, o.conduction_number);
  return *this;
}

DetailSums sum_details(const HeatDetails* details, const HeatedParticles& p,
                       std::span<const double> capacity, double dt, Range range) {
  DetailSums sum;
  for (int i = range.begin; i < range.end; ++i) {
    sum.friction += details[i].friction;
    sum.damping += details[i].damping;
    const double mc = p.mass[i] * capacity[std::size_t(p.type[i]) - 1];
    sum.conduction_number = std::max(sum.conduction_number, dt * details[i].conductance / mc);
  }
  return sum;
}

HeatPowers step_temperature(const HeatedParticles& p, std::span<const double> capacity, int held,
                            double dt, Range range) {
  if (p.walls)
    return p.gas ? step<true, true>(p, capacity, held, dt, range)
                 : step<true, false>(p, capacity, held, dt, range);
  return p.gas ? step<false, true>(p, capacity, held, dt, range)
               : step<false, false>(p, capacity, held, dt, range);
}

} // namespace granflux::particle_subset
