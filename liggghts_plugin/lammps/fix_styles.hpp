// SPDX-FileCopyrightText: 2026 The GranFlux developers
// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

namespace LAMMPS_NS {
class Fix;
class LAMMPS;
} // namespace LAMMPS_NS

namespace granflux::lammps {

/// A fix style and what makes a fix of it, as LAMMPS' table of styles takes them.
struct FixStyle {
  const char* name;
  LAMMPS_NS::Fix* (*create)(LAMMPS_NS::LAMMPS*, int narg, char** arg);
};

LAMMPS_NS::Fix* create_checkpoint(LAMMPS_NS::LAMMPS* lammps, int narg, char** arg);
LAMMPS_NS::Fix* create_couple(LAMMPS_NS::LAMMPS* lammps, int narg, char** arg);
LAMMPS_NS::Fix* create_heat(LAMMPS_NS::LAMMPS* lammps, int narg, char** arg);

/// The styles of GranFlux.
inline constexpr FixStyle fix_styles[] = {{"granflux/checkpoint", create_checkpoint},
                                          {"granflux/couple", create_couple},
                                          {"granflux/heat", create_heat}};

} // namespace granflux::lammps
