// SPDX-FileCopyrightText: 2026 The GranFlux developers
// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

#include <granflux/coupling/effects/scene_state.hpp>

#include "driver/scene.hpp"

namespace LAMMPS_NS {
class LAMMPS;
}

namespace granflux::lammps {

driver::Script script_of(LAMMPS_NS::LAMMPS& lammps);

/// Collective.
driver::Scene scene_of(LAMMPS_NS::LAMMPS& lammps);

/// The particles of the script, its gravity and its box. Collective.
void describe_particles(LAMMPS_NS::LAMMPS& lammps, coupling::SceneState& scene);

} // namespace granflux::lammps
