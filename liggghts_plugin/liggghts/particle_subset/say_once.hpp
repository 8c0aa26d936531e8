// SPDX-FileCopyrightText: 2026 The GranFlux developers
// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

#include <string>

namespace LAMMPS_NS {
class LAMMPS;
}

namespace granflux::particle_subset {

/// One line on screen and in the log, by the first rank, the first time that it is said.
void say_once(LAMMPS_NS::LAMMPS& lammps, const std::string& line);

} // namespace granflux::particle_subset
