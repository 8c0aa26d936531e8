// SPDX-FileCopyrightText: 2026 The GranFlux developers
// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

#include <liggghts/modify.h>

#include "particles.hpp"

namespace granflux::particle_subset {

/// What particles and ghosts have in common now.
[[nodiscard]] Alike find_alike(const Particles& particles);

/// Whether every fix is known to leave radius and mass of particles as they are between two builds
/// of the lists.
[[nodiscard]] bool sizes_stay(const LAMMPS_NS::Modify& modify);

} // namespace granflux::particle_subset
