// SPDX-FileCopyrightText: 2026 The GranFlux developers
// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

#include <span>
#include <vector>

#include "driver/heat_options.hpp"

namespace granflux::lammps {

/// What follows the style name in `fix ID all granflux/heat ...`: LAMMPS has no properties of types
/// that a fix could look up, so that they are words of the fix.
struct HeatWords {
  driver::HeatOptions options;
  std::vector<double> capacity; ///< `thermal_capacity`, of each type [J/(kg K)]
  std::vector<particle_subset::ThermalMaterial> materials;
  bool knows_moduli = false; ///< else those of the materials are of no use
};

/// `types`: of particles. Throws ConfigError that names the word and what is allowed.
HeatWords read_heat_words(std::span<char*> all_words, int types);

} // namespace granflux::lammps
