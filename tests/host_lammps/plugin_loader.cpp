// SPDX-FileCopyrightText: 2026 The GranFlux developers
// SPDX-License-Identifier: BSD-3-Clause
//
// plugin_loader [options of lmp]: runs a script after it has loaded the module that GRANFLUX_PLUGIN
// names, the way LAMMPS' command `plugin load` does by its manual ("Writing plugins"). Debian's
// LAMMPS has no such command.

#include <cstdlib>
#include <cstring>

#include <dlfcn.h>
#include <fmt/core.h>
#include <mpi.h>

#include "lammps/fmt_of_lammps.hpp"

#include <lammps/input.h>
#include <lammps/lammps.h>
#include <lammps/modify.h>

namespace {

// As the manual declares it, and not as the module does.
struct lammpsplugin_t {
  const char *version, *style, *name, *info, *author;
  void* creator;
  void* handle;
};
using Init = void (*)(void* lammps, void* handle, void* register_style);

void* module_handle = nullptr;

void register_style(lammpsplugin_t* plugin, void* host) {
  auto& lammps = *static_cast<LAMMPS_NS::LAMMPS*>(host);
  const bool understood = std::strcmp(plugin->style, "fix") == 0 &&
                          std::strcmp(plugin->version, lammps.version) == 0 &&
                          plugin->handle == module_handle && *plugin->info && *plugin->author;
  fmt::print("{} {} style {}\n", understood ? "loaded" : "REFUSED", plugin->style, plugin->name);
  if (understood)
    (*lammps.modify->fix_map)[plugin->name] =
        reinterpret_cast<LAMMPS_NS::Modify::FixCreator>(plugin->creator);
}

} // namespace

int main(int argc, char** argv) {
  MPI_Init(&argc, &argv);
  {
    LAMMPS_NS::LAMMPS lammps(argc, argv, MPI_COMM_WORLD);
    module_handle = dlopen(std::getenv("GRANFLUX_PLUGIN"), RTLD_NOW | RTLD_GLOBAL);
    const auto init =
        module_handle ? reinterpret_cast<Init>(dlsym(module_handle, "lammpsplugin_init")) : nullptr;
    if (!init) {
      fmt::print(stderr, "ERROR: {}\n", dlerror());
      return 1;
    }
    init(&lammps, module_handle, reinterpret_cast<void*>(&register_style));
    lammps.input->file();
  }
  MPI_Finalize();
}
