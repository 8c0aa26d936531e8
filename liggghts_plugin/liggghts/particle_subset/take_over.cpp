// SPDX-FileCopyrightText: 2026 The GranFlux developers
// SPDX-License-Identifier: GPL-2.0-or-later

#include "take_over.hpp"

#include <liggghts/lammps.h>

#include "fix_gravity.hpp"
#include "fix_nve_sphere.hpp"
#include "fix_wall_gran.hpp"
#include "neighbor.hpp"

namespace granflux::particle_subset {

namespace {

template <class Style> LAMMPS_NS::Fix* create(LAMMPS_NS::LAMMPS* lammps, int count, char** words) {
  return new Style(lammps, count, words); // owned by Modify
}

} // namespace

void take_over(LAMMPS_NS::LAMMPS& lammps, FixStyles& styles) {
  delete lammps.neighbor;
  lammps.neighbor = new Neighbor(&lammps); // owned by lammps
  styles["nve/sphere"] = create<FixNveSphere>;
  styles["gravity"] = create<FixGravity>;
  styles["wall/gran"] = create<FixWallGran>;
}

} // namespace granflux::particle_subset
