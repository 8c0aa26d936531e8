// SPDX-FileCopyrightText: 2026 The GranFlux developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

namespace granflux::coupling {

/// What one particle and the gas exchange in heat between two coupling steps. Plain doubles, so
/// that a host keeps it as a per-particle array; all zero for a new particle.
struct HeatState {
  double conductance = 0;     ///< h pi d^2 [W/K]; 0: not coupled
  double gas_temperature = 0; ///< at the particle [K]
  double received = 0;        ///< since the last coupling step [J]
  double booked = 0;          ///< taken from the gas for it at that coupling step [J]
};
inline constexpr int heat_state_doubles = 4;
static_assert(sizeof(HeatState) == heat_state_doubles * sizeof(double));

} // namespace granflux::coupling
