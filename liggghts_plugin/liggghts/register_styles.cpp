// SPDX-FileCopyrightText: 2026 The GranFlux developers
// SPDX-License-Identifier: GPL-2.0-or-later

#include "register_styles.hpp"

#include <map>
#include <string>

#include <liggghts/lammps.h>

#include <liggghts/modify.h>

#include "fix_couple.hpp"
#include "fix_heat.hpp"
#include "launch_options.hpp"
#include "particle_subset/take_over.hpp"

// LIGGGHTS has no plugin loader, and its table of fix styles, Modify::fix_map, is private. The
// language lets an explicit instantiation name a private member ([temp.spec]/6). FixMapAccess
// hands the pointer to that member on through a friend function; nothing else reaches it.
namespace {

using LAMMPS_NS::Fix;
using LAMMPS_NS::LAMMPS;
using LAMMPS_NS::Modify;

using FixCreator = Fix* (*)(LAMMPS*, int, char**);
using FixMapMember = std::map<std::string, FixCreator>* Modify::*;

struct FixMapTag {
  friend FixMapMember fix_map_member(FixMapTag);
};
template <FixMapMember member> struct FixMapAccess {
  friend FixMapMember fix_map_member(FixMapTag) { return member; }
};
template struct FixMapAccess<&Modify::fix_map>;

template <class Style> Fix* create(LAMMPS* lammps, int narg, char** arg) {
  return new Style(lammps, narg, arg); // owned by Modify
}

} // namespace

void granflux::liggghts::register_styles(LAMMPS& lammps) {
  auto& styles = *(lammps.modify->*fix_map_member(FixMapTag{}));
  styles["granflux/couple"] = create<FixCouple>;
  styles["granflux/heat"] = create<FixHeat>;
  if (launch_options().subset)
    particle_subset::take_over(lammps, styles);
}
