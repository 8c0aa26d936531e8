// SPDX-FileCopyrightText: 2026 The GranFlux developers
// SPDX-License-Identifier: GPL-2.0-or-later

#include "take_over.hpp"

#include <liggghts/lammps.h>

#include <liggghts/force.h>

#include "fix_contact_history.hpp"
#include "fix_gravity.hpp"
#include "fix_nve_sphere.hpp"
#include "fix_wall_gran.hpp"
#include "neighbor.hpp"
#include "pair_gran.hpp"

namespace granflux::particle_subset {

namespace {

template <class Style> LAMMPS_NS::Fix* create(LAMMPS_NS::LAMMPS* lammps, int count, char** words) {
  return new Style(lammps, count, words); // owned by Modify
}

LAMMPS_NS::Pair* create_pair_gran(LAMMPS_NS::LAMMPS* lammps) {
  return new PairGran(lammps); // owned by Force
}

} // namespace

void take_over(LAMMPS_NS::LAMMPS& lammps, FixStyles& styles) {
  delete lammps.neighbor;
  lammps.neighbor = new Neighbor(&lammps); // owned by lammps
  (*lammps.force->pair_map)["gran"] = create_pair_gran;
  styles["contacthistory"] = create<FixContactHistory>;
  styles["nve/sphere"] = create<FixNveSphere>;
  styles["gravity"] = create<FixGravity>;
  styles["wall/gran"] = create<FixWallGran>;
}

} // namespace granflux::particle_subset
