// SPDX-FileCopyrightText: 2026 The GranFlux developers
// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

#include "driver/contact_time.hpp"

namespace LAMMPS_NS {
class LAMMPS;
}

namespace granflux::lammps {

/// By the constants of `pair_style gran/...` and the particles as they are. Collective.
driver::ContactTimes contact_times_of(LAMMPS_NS::LAMMPS& lammps);

} // namespace granflux::lammps
