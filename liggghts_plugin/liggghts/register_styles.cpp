// SPDX-FileCopyrightText: 2026 The GranFlux developers
// SPDX-License-Identifier: GPL-2.0-or-later

#include "register_styles.hpp"

#include <map>
#include <string>
#include <utility>

#include <liggghts/lammps.h>

#include <liggghts/error.h>
#include <liggghts/input.h>
#include <liggghts/modify.h>

#include <granflux/cfd/error.hpp>

#include "driver/sealed_file.hpp"
#include "fix_checkpoint.hpp"
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

// Of Input, in the same way, the table of commands.
using Command = void (*)(LAMMPS*, int, char**);
using CommandMapMember = std::map<std::string, Command>* LAMMPS_NS::Input::*;

struct CommandMapTag {
  friend CommandMapMember command_map_member(CommandMapTag);
};
template <CommandMapMember member> struct CommandMapAccess {
  friend CommandMapMember command_map_member(CommandMapTag) { return member; }
};
template struct CommandMapAccess<&LAMMPS_NS::Input::command_map>;

Command stock_read_restart = nullptr;

/// A damaged checkpoint is refused before LIGGGHTS makes what it can of it.
void read_restart(LAMMPS* lammps, int narg, char** arg) {
  try {
    if (narg > 0)
      granflux::driver::check_restart_file(arg[0], lammps->world);
  } catch (const granflux::ConfigError& e) { // on all ranks alike
    lammps->error->all(FLERR, e.what());
  }
  stock_read_restart(lammps, narg, arg);
}

template <class Style> Fix* create(LAMMPS* lammps, int narg, char** arg) {
  return new Style(lammps, narg, arg); // owned by Modify
}

} // namespace

void granflux::liggghts::register_styles(LAMMPS& lammps) {
  auto& styles = *(lammps.modify->*fix_map_member(FixMapTag{}));
  styles["granflux/checkpoint"] = create<FixCheckpoint>;
  styles["granflux/couple"] = create<FixCouple>;
  styles["granflux/heat"] = create<FixHeat>;
  Command& reader = (*(lammps.input->*command_map_member(CommandMapTag{})))["read_restart"];
  if (reader != read_restart) // `clear` keeps the commands
    stock_read_restart = std::exchange(reader, read_restart);
  if (launch_options().subset)
    particle_subset::take_over(lammps, styles);
}
