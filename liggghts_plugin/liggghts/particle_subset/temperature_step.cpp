// SPDX-FileCopyrightText: 2026 The GranFlux developers
// SPDX-License-Identifier: GPL-2.0-or-later

#include "temperature_step.hpp"

#include <algorithm>

#include <granflux/coupling/heat_kick.hpp>

namespace granflux::particle_subset {

StepPowers& StepPowers::operator+=(const StepPowers& o) & {
  convection += o.convection;
  source += o.source;
  held += o.held;
  return *this;
}

namespace {

/// What the script does not use leaves no instruction in the loop, which then runs on vector
/// registers.
template <bool one_type, bool with_gas, bool some_held>
StepPowers step(const HeatedParticles& p, std::span<const double> capacity, int held, double dt,
                Range range) {
  const double common = capacity[0];
  double convection = 0, source = 0, taken = 0;
#pragma omp simd reduction(+ : convection, source, taken)
  for (int i = range.begin; i < range.end; ++i) {
    const double mc = p.mass[i] * (one_type ? common : capacity[std::size_t(p.type[i]) - 1]);
    const bool is_held = some_held && (p.groups[i] & held) != 0;
    double total = p.heat_flux[i] + p.source[i];
    if constexpr (with_gas) {
      const double heat =
          coupling::convected_heat(p.gas[i], p.temperature[i], total, mc, is_held, dt);
      convection += heat;
      p.heat_flux[i] += heat;
      total += heat;
    }
    source += p.source[i];
    // What the sum rounds off is kept: steps of 1e-6 s warm by less than the last digit.
    const double change = dt * total / mc + p.carry[i];
    const double warmer = p.temperature[i] + change;
    const double rounded_off = change - (warmer - p.temperature[i]);
    if constexpr (some_held) {
      taken += is_held ? total : 0;
      p.carry[i] = is_held ? p.carry[i] : rounded_off;
      p.temperature[i] = is_held ? p.temperature[i] : warmer;
    } else {
      p.carry[i] = rounded_off;
      p.temperature[i] = warmer;
    }
  }
  return {.convection = convection, .source = source, .held = taken};
}

template <bool one_type, bool with_gas>
StepPowers step(const HeatedParticles& p, std::span<const double> capacity, int held, double dt,
                Range range) {
  return held ? step<one_type, with_gas, true>(p, capacity, held, dt, range)
              : step<one_type, with_gas, false>(p, capacity, held, dt, range);
}

} // namespace

StepPowers step_temperature(const HeatedParticles& p, std::span<const double> capacity, int held,
                            double dt, Range range) {
  if (capacity.size() == 1)
    return p.gas ? step<true, true>(p, capacity, held, dt, range)
                 : step<true, false>(p, capacity, held, dt, range);
  return p.gas ? step<false, true>(p, capacity, held, dt, range)
               : step<false, false>(p, capacity, held, dt, range);
}

double conduction_number(const HeatShown& shown, const HeatedParticles& p,
                         std::span<const double> capacity, double dt, Range range) {
  double largest = 0;
  for (int i = range.begin; i < range.end; ++i) {
    const double mc = p.mass[i] * capacity[std::size_t(p.type[i]) - 1];
    const double conductance =
        shown.details[i].conductance + (shown.near ? shown.near[i].conductance : 0);
    largest = std::max(largest, dt * conductance / mc);
  }
  return largest;
}

} // namespace granflux::particle_subset
