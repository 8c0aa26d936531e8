// SPDX-FileCopyrightText: 2026 The GranFlux developers
// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

#include <string>

namespace LAMMPS_NS {
class LAMMPS;
}

namespace granflux::liggghts {

/// The time step of a run of particles alone beside what its contacts allow; empty in a run with
/// gas, whose fix tells more, and without particles. Collective.
std::string contact_report(LAMMPS_NS::LAMMPS& lammps);

} // namespace granflux::liggghts
