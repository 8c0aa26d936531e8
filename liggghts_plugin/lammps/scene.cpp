// SPDX-FileCopyrightText: 2026 The GranFlux developers
// SPDX-License-Identifier: GPL-2.0-or-later

#include "scene.hpp"

#include <string_view>

#include <fmt/core.h>

#include "fmt_of_lammps.hpp"

#include <lammps/fix.h>
#include <lammps/lammps.h>
#include <lammps/modify.h>

#include "driver/fixes_of_run.hpp"

namespace granflux::lammps {

/// The class of fix gravity has no installed header; it hands its vector out by name.
std::optional<Vec3> gravity_of(LAMMPS_NS::LAMMPS& lammps) {
  std::optional<Vec3> sum;
  for (LAMMPS_NS::Fix* fix : driver::fixes_of(*lammps.modify)) {
    if (std::string_view(fix->style) != "gravity")
      continue;
    int dimension = 0;
    const auto* g = static_cast<const double*>(fix->extract("gvec", dimension));
    sum = sum.value_or(Vec3{}) + Vec3{g[0], g[1], g[2]};
  }
  return sum;
}

std::string rigid_fix_of(LAMMPS_NS::LAMMPS& lammps) {
  for (const LAMMPS_NS::Fix* fix : driver::fixes_of(*lammps.modify))
    if (fix->rigid_flag)
      return fmt::format("fix {} (style {})", fix->id, fix->style);
  return {};
}

} // namespace granflux::lammps
