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
  double* heat_flux = nullptr;    ///< received but from gas and source; out: from the gas too [W]
  const double* source = nullptr; ///< W
  const double* mass = nullptr;   ///< kg
  const int* type = nullptr;      ///< from 1 on
  const int* groups = nullptr;    ///< one bit each
  coupling::HeatState* gas = nullptr; ///< optional: convection
};

/// What a step of temperature adds to the heat that particles receive [W].
struct StepPowers {
  double convection = 0; ///< from the gas
  double source = 0;
  double held = 0; ///< taken off those of fixed temperature

  StepPowers& operator+=(const StepPowers& o) &;
};

/// One step of `dt` seconds for the particles of `range`: Euler's forward step with the rates of
/// contacts, and exactly for the exchange with gas of constant temperature, however stiff. The
/// temperatures of particles of the groups `held` stay. `capacity`: J/(kg K) of types from 1 on.
[[nodiscard]] StepPowers step_temperature(const HeatedParticles& p,
                                          std::span<const double> capacity, int held, double dt,
                                          Range range);

/// Largest dt * conductance / heat capacity of a particle of `range`: above 1 conduction and
/// radiation overshoot.
[[nodiscard]] double conduction_number(const HeatShown& shown, const HeatedParticles& p,
                                       std::span<const double> capacity, double dt, Range range);

} // namespace granflux::particle_subset
