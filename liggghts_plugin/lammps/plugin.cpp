// SPDX-FileCopyrightText: 2026 The GranFlux developers
// SPDX-License-Identifier: GPL-2.0-or-later
//
// The fixes of GranFlux as a module for LAMMPS' own command `plugin load granfluxplugin.so`.

#include "plugin_interface.hpp"

#include <string>

#include "fmt_of_lammps.hpp"

#include <lammps/error.h>
#include <lammps/lammps.h>
#include <lammps/pointers.h>

#include "fix_styles.hpp"

extern "C" [[gnu::visibility("default")]] void lammpsplugin_init(void* lammps, void* handle,
                                                                 void* registration) {
  using namespace granflux::lammps;
  auto* host = static_cast<LAMMPS_NS::LAMMPS*>(lammps);
  // LAMMPS itself only says so; but the layout of its classes belongs to one release.
  if (host->num_ver != GRANFLUX_LAMMPS_RELEASE)
    host->error->all(FLERR, std::string("the module of GranFlux was compiled for another release "
                                        "of LAMMPS: build it again"));
  const auto register_style = reinterpret_cast<RegisterStyle>(registration);
  for (const FixStyle& style : fix_styles) {
    PluginStyle plugin{.version = host->version,
                       .style = "fix",
                       .name = style.name,
                       .info = "gas by GranFlux",
                       .author = "The GranFlux developers",
                       .creator = {.of_words = reinterpret_cast<StyleOfArguments*>(style.create)},
                       .handle = handle};
    register_style(&plugin, lammps);
  }
}
