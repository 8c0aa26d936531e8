// SPDX-FileCopyrightText: 2026 The GranFlux developers
// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

#include <optional>
#include <string>

#include <granflux/cfd/vec3.hpp>

namespace LAMMPS_NS {
class LAMMPS;
}

namespace granflux::lammps {

/// Sum of the script's constant gravities, if it has any [m/s2].
std::optional<Vec3> gravity_of(LAMMPS_NS::LAMMPS& lammps);

/// "fix ID (style STYLE)" of one that holds spheres together, or empty.
std::string rigid_fix_of(LAMMPS_NS::LAMMPS& lammps);

} // namespace granflux::lammps
