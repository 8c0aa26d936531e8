// SPDX-FileCopyrightText: 2026 The GranFlux developers
// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

#include <cstdio>
#include <string>

namespace granflux::driver {

/// To screen and log of a host, once for all ranks. `Lammps`: the host's class of that name.
template <class Lammps> void say(const Lammps& host, const std::string& text) {
  if (host.comm->me != 0)
    return;
  for (std::FILE* out : {host.screen, host.logfile})
    if (out) {
      std::fputs(text.c_str(), out);
      std::fflush(out);
    }
}

} // namespace granflux::driver
