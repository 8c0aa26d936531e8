// SPDX-FileCopyrightText: 2026 The GranFlux developers
// SPDX-License-Identifier: GPL-2.0-or-later
//
// LAMMPS' constructor and the script command `clear` make a new table of styles, with the stock
// ones only, and then call LAMMPS::post_create. A definition in the program comes before that of a
// shared library (ELF symbol interposition), so the calls arrive here: do the stock work, then add
// the styles of GranFlux.

#include <dlfcn.h>
#include <string>
#include <utility>

#include <fmt/core.h>

#include "fmt_of_lammps.hpp"

#include <lammps/error.h>
#include <lammps/input.h>
#include <lammps/lammps.h>
#include <lammps/modify.h>
#include <lammps/pointers.h>

#include <granflux/cfd/error.hpp>

#include "driver/sealed_file.hpp"
#include "fix_styles.hpp"

namespace {

/// The fixes derive from classes of the library, whose layout belongs to one release of it.
void check_release(LAMMPS_NS::LAMMPS& lammps) {
  if (lammps.num_ver != GRANFLUX_LAMMPS_RELEASE)
    lammps.error->all(FLERR, fmt::format("granflux_lammps was compiled against release {}, but "
                                         "the library is release {}: build it again",
                                         GRANFLUX_LAMMPS_RELEASE, lammps.num_ver));
}

LAMMPS_NS::Input::CommandCreator stock_read_restart = nullptr;

/// A damaged checkpoint is refused before LAMMPS makes what it can of it.
LAMMPS_NS::Command* read_restart(LAMMPS_NS::LAMMPS* lammps) {
  try {
    if (lammps->input->narg > 0)
      granflux::driver::check_restart_file(lammps->input->arg[0], lammps->world);
  } catch (const granflux::ConfigError& e) { // on all ranks alike
    lammps->error->all(FLERR, std::string(e.what()));
  }
  return stock_read_restart(lammps);
}

} // namespace

[[gnu::visibility("default")]] void LAMMPS_NS::LAMMPS::post_create() {
  using PostCreate = void (*)(LAMMPS*);
  static const auto stock =
      reinterpret_cast<PostCreate>(dlsym(RTLD_NEXT, "_ZN9LAMMPS_NS6LAMMPS11post_createEv"));
  stock(this);
  check_release(*this);
  for (const granflux::lammps::FixStyle& style : granflux::lammps::fix_styles)
    (*modify->fix_map)[style.name] = style.create;
  LAMMPS_NS::Input::CommandCreator& reader = (*input->command_map)["read_restart"];
  if (reader != read_restart) // `clear` keeps the commands
    stock_read_restart = std::exchange(reader, read_restart);
}
