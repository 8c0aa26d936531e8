// SPDX-FileCopyrightText: 2026 The GranFlux developers
// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

#include <vector>

#include <liggghts/pointers.h>

#include "driver/heat_options.hpp"

namespace granflux::liggghts {

/// Thermal constants of the script's types, from its `fix property/global`.
struct HeatMaterials {
  std::vector<double> capacity; ///< of each type [J/(kg K)]
  std::vector<particle_subset::ThermalMaterial> materials;
  std::vector<double> overlap_ratio; ///< of each pair of types
  std::vector<double> emissivity;    ///< of each type, where there is radiation
};

/// Throws ConfigError where a property that the options call for is missing or not positive.
HeatMaterials read_heat_materials(LAMMPS_NS::LAMMPS& lammps, const driver::HeatOptions& wanted);

} // namespace granflux::liggghts
