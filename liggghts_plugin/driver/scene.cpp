// SPDX-FileCopyrightText: 2026 The GranFlux developers
// SPDX-License-Identifier: GPL-2.0-or-later

#include "scene.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/core.h>

#include <granflux/cfd/error.hpp>

namespace granflux::driver {

namespace {

constexpr char direction_name[] = {'x', 'y', 'z'};

} // namespace

void check_script(const Script& script) {
  if (script.units != "si")
    throw ConfigError(fmt::format("units {}: must be si", script.units));
  if (!script.radius_and_mass)
    throw ConfigError(fmt::format("atom_style {}: particles must have a radius and a mass each, as "
                                  "those of atom_style sphere",
                                  script.atom_style));
  if (script.triclinic)
    throw ConfigError("the simulation box is triclinic: it must be orthogonal");
  if (script.run_style.find("verlet") == std::string::npos)
    throw ConfigError(fmt::format("run_style {}: must be verlet", script.run_style));
  if (script.minimises)
    throw ConfigError("minimize does not move particles in time: unfix the gas before it");
  if (!script.rigid_fix.empty())
    throw ConfigError(
        fmt::format("{}: rigid bodies of several spheres cannot be coupled", script.rigid_fix));
}

void check_box(const Scene& scene, const coupling::GridExtent& grid, bool is_box) {
  for (std::size_t d = 0; d < 3; ++d) {
    const char name = direction_name[d];
    const double gas_low = grid.low[int(d)], gas_high = grid.high[int(d)];
    const bool periodic = scene.periodic[d];
    if (grid.periodic[d] != periodic)
      throw ConfigError(fmt::format("direction {} is {} for the gas grid, but {} for the "
                                    "simulation box (boundary command)",
                                    name, grid.periodic[d] ? "periodic" : "not periodic",
                                    periodic ? "periodic" : "not periodic"));
    if (!is_box && !periodic)
      continue;
    const double round_off = 1e-10 * (gas_high - gas_low);
    // A box that is still empty has no diameter to go by.
    const double allowed = periodic ? round_off : std::max(2 * scene.largest_radius, round_off);
    const auto compare = [&](const char* side, double gas, double particles) {
      if (!(std::abs(gas - particles) <= allowed))
        throw ConfigError(fmt::format(
            "{} side in {}: the gas grid is at {} m, the simulation box at {} m; they may differ "
            "by {} m ({})",
            side, name, gas, particles, allowed,
            periodic ? "periodic: round-off" : "one particle diameter; 'box any' allows more"));
    };
    if (!scene.shrink_wrapped[d][0])
      compare("low", gas_low, scene.low[d]);
    if (!scene.shrink_wrapped[d][1])
      compare("high", gas_high, scene.high[d]);
  }
}

std::string settle_gravity(const Scene& scene, cfd::Fluid& fluid) {
  if (!scene.gravity)
    return fluid.gravity_given ? ""
                               : "no gravity: neither the script (fix gravity) nor the gas case "
                                 "gives any";
  const Vec3& script = *scene.gravity;
  if (!fluid.gravity_given) {
    fluid.gravity = script;
    return {};
  }
  if (norm(fluid.gravity - script) > 1e-6 * std::max(norm(fluid.gravity), norm(script)))
    throw ConfigError(fmt::format(
        "gravity of the gas case is ({}, {}, {}) m/s2, that of fix gravity ({}, {}, {}): they must "
        "agree; leave it out of the case to take the script's",
        fluid.gravity.x, fluid.gravity.y, fluid.gravity.z, script.x, script.y, script.z));
  return {};
}

} // namespace granflux::driver
