// SPDX-FileCopyrightText: 2026 The GranFlux developers
// SPDX-License-Identifier: GPL-2.0-or-later

#include "fix_styles.hpp"

#include "fix_checkpoint.hpp"
#include "fix_couple.hpp"
#include "fix_heat.hpp"

namespace granflux::lammps {

LAMMPS_NS::Fix* create_checkpoint(LAMMPS_NS::LAMMPS* lammps, int narg, char** arg) {
  return new FixCheckpoint(lammps, narg, arg); // owned by Modify
}

LAMMPS_NS::Fix* create_couple(LAMMPS_NS::LAMMPS* lammps, int narg, char** arg) {
  return new FixCouple(lammps, narg, arg);
}

LAMMPS_NS::Fix* create_heat(LAMMPS_NS::LAMMPS* lammps, int narg, char** arg) {
  return new FixHeat(lammps, narg, arg);
}

} // namespace granflux::lammps
