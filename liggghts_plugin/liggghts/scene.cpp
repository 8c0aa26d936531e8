// SPDX-FileCopyrightText: 2026 The GranFlux developers
// SPDX-License-Identifier: GPL-2.0-or-later

#include "scene.hpp"

#include <string_view>

#include <fmt/core.h>

#include <liggghts/lammps.h>

#include <liggghts/fix_gravity.h>
#include <liggghts/modify.h>

#include "driver/fixes_of_run.hpp"

namespace granflux::liggghts {

std::optional<Vec3> gravity_of(LAMMPS_NS::LAMMPS& lammps) {
  std::optional<Vec3> sum;
  for (LAMMPS_NS::Fix* fix : driver::fixes_of(*lammps.modify)) {
    if (std::string_view(fix->style) != "gravity")
      continue;
    double g[3];
    static_cast<LAMMPS_NS::FixGravity*>(fix)->get_gravity(g);
    sum = sum.value_or(Vec3{}) + Vec3{g[0], g[1], g[2]};
  }
  return sum;
}

std::string rigid_fix_of(LAMMPS_NS::LAMMPS& lammps) {
  for (const LAMMPS_NS::Fix* fix : driver::fixes_of(*lammps.modify)) {
    const std::string_view style = fix->style;
    if (style.starts_with("multisphere") || style.starts_with("rigid"))
      return fmt::format("fix {} (style {})", fix->id, style);
  }
  return {};
}

} // namespace granflux::liggghts
