// SPDX-FileCopyrightText: 2026 The GranFlux developers
// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

#include <vector>

namespace LAMMPS_NS {
class Atom;
class Modify;
} // namespace LAMMPS_NS

namespace granflux::particle_subset {

/// Moves the particles of a rank, each with all that fixes keep of it: number k becomes what
/// from[k] was, each number once. `from` is used up. There must be no ghosts.
void reorder(LAMMPS_NS::Atom& atom, LAMMPS_NS::Modify& modify, std::vector<int>& from);

} // namespace granflux::particle_subset
