// SPDX-FileCopyrightText: 2026 The GranFlux developers
// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

#include <map>
#include <string>

namespace LAMMPS_NS {
class Fix;
class LAMMPS;
} // namespace LAMMPS_NS

namespace granflux::particle_subset {

using FixStyles = std::map<std::string, LAMMPS_NS::Fix* (*)(LAMMPS_NS::LAMMPS*, int, char**)>;

/// Puts the threaded forms in the place of LIGGGHTS' own: neighbour lists at once, fixes under
/// their names in `styles`, the time step when a run begins. To be called before the script
/// defines anything.
void take_over(LAMMPS_NS::LAMMPS& lammps, FixStyles& styles);

} // namespace granflux::particle_subset
