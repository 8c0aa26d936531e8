// SPDX-FileCopyrightText: 2026 The GranFlux developers
// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

#include <vector>

#include <liggghts/pointers.h>

#include "particle_subset/contact_heat.hpp"

namespace granflux::liggghts {

/// Thermal constants of the script's types, from its `fix property/global`.
struct HeatMaterials {
  std::vector<double> capacity; ///< of each type [J/(kg K)]
  std::vector<particle_subset::ThermalMaterial> materials;
  std::vector<double> overlap_ratio; ///< of each pair of types
};

/// Throws ConfigError where a property that the options call for is missing or not positive.
HeatMaterials read_heat_materials(LAMMPS_NS::LAMMPS& lammps,
                                  const particle_subset::ContactHeatOptions& options);

} // namespace granflux::liggghts
