// SPDX-FileCopyrightText: 2026 The GranFlux developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <granflux/coupling/fluid_kick.hpp>
#include <granflux/coupling/heat_state.hpp>

namespace granflux::coupling {

/// Heat from the gas [W], mean over `dt` seconds, that takes a particle from `temperature` [K] to
/// the exact end of C dT/dt = conductance (gas_temperature - T) + other, when `other` [W] is
/// received as well; however stiff the exchange, the temperature stays between its bounds. C is the
/// particle's heat capacity [J/K]. A particle of fixed temperature receives heat at that. Booked in
/// the state.
[[nodiscard]] inline double convected_heat(HeatState& state, double temperature, double other,
                                           double capacity, bool fixed, double dt) {
  const DragResponse r = drag_response(fixed ? 0 : state.conductance * dt / capacity);
  const double heat =
      state.conductance * r.mean * (state.gas_temperature - temperature) + r.lag * other;
  state.received += heat * dt;
  return heat;
}

} // namespace granflux::coupling
