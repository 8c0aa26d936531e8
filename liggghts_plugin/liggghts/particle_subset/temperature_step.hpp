// SPDX-FileCopyrightText: 2026 The GranFlux developers
// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

#include <span>

#include <granflux/coupling/heat_state.hpp>

#include "contact_heat.hpp"
#include "subset.hpp"

namespace granflux::particle_subset {

/// Particles whose temperature is integrated. Arrays of a rank; what is optional may be null.
struct HeatedParticles {
  double* temperature = nullptr;  ///< K
  double* carry = nullptr;        ///< what rounding has kept from the temperature [K]
  double* heat_flux = nullptr;    ///< out: all that is received but the source [W]
  const double* source = nullptr; ///< W
  const double* mass = nullptr;   ///< kg
  const int* type = nullptr;      ///< from 1 on
  const int* groups = nullptr;    ///< one bit each
  const HeatRates* contacts = nullptr;
  const WallHeatRates* walls = nullptr; ///< optional
  coupling::HeatState* gas = nullptr;   ///< optional: convection
};

/// Heat that particles of a range received in one step [W].
struct HeatPowers {
  double conduction = 0; ///< from other particles: sums to zero over all of them
  double walls = 0;      ///< conducted from walls
  double made = 0;       ///< by friction and damping
  double convection = 0;
  double source = 0;
  double to_walls = 0; ///< made in contacts and gone into walls, not into particles
  double held = 0;     ///< taken off those of fixed temperature

  HeatPowers& operator+=(const HeatPowers& o) &;
};

/// One step of `dt` seconds for the particles of `range`: Euler's forward step with the rates of
/// contacts, and exactly for the exchange with gas of constant temperature, however stiff. The
/// temperatures of particles of the groups `held` stay. `capacity`: J/(kg K) of types from 1 on.
[[nodiscard]] HeatPowers step_temperature(const HeatedParticles& p,
                                          std::span<const double> capacity, int held, double dt,
                                          Range range);

/// What the details of the contacts of a range add up to.
struct DetailSums {
  double friction = 0, damping = 0; ///< W
  /// Largest dt * conductance / heat capacity of a particle: above 1 conduction overshoots.
  double conduction_number = 0;

  DetailSums& operator+=(const DetailSums& o) &;
};
[[nodiscard]] DetailSums sum_details(const HeatDetails* details, const HeatedParticles& p,
                                     std::span<const double> capacity, double dt, Range range);

} // namespace granflux::particle_subset
