// SPDX-FileCopyrightText: 2026 The GranFlux developers
// SPDX-License-Identifier: GPL-2.0-or-later

#include "say_once.hpp"

#include <set>

#include <fmt/core.h>

#include <liggghts/lammps.h>

#include <liggghts/comm.h>

namespace granflux::particle_subset {

void say_once(LAMMPS_NS::LAMMPS& lammps, const std::string& line) {
  static std::set<std::string> said;
  if (!said.insert(line).second || lammps.comm->me != 0)
    return;
  if (lammps.screen)
    fmt::print(lammps.screen, "granflux: {}\n", line);
  if (lammps.logfile)
    fmt::print(lammps.logfile, "granflux: {}\n", line);
}

} // namespace granflux::particle_subset
