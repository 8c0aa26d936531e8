// SPDX-FileCopyrightText: 2026 The GranFlux developers
// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

namespace LAMMPS_NS {
class LAMMPS;
}

namespace granflux::liggghts {

/// Makes the styles of GranFlux known to the script commands of this LIGGGHTS.
void register_styles(LAMMPS_NS::LAMMPS& lammps);

} // namespace granflux::liggghts
