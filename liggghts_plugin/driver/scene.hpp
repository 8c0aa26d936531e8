// SPDX-FileCopyrightText: 2026 The GranFlux developers
// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

#include <array>
#include <optional>
#include <string>

#include <granflux/cfd/gas_case.hpp>
#include <granflux/coupling/grid_extent.hpp>

namespace granflux::driver {

/// What the script of a host has set up, as far as it decides whether it can be coupled.
struct Script {
  std::string units, atom_style, run_style;
  bool radius_and_mass = false; ///< each particle has its own
  bool triclinic = false;
  bool minimises = false;
  std::string rigid_fix; ///< "fix ID (style STYLE)" of one that holds spheres together, or empty
};

/// The script must be one that can be coupled: units si, spheres with radius and mass, an
/// orthogonal box, plain Verlet steps, no rigid clumps, no minimisation. Throws ConfigError.
void check_script(const Script& script);

/// What the gas is compared with before its first step.
struct Scene {
  std::array<double, 3> low{}, high{}; ///< of the simulation box [m]
  std::array<bool, 3> periodic{};
  /// Sides that follow the particles: low, high.
  std::array<std::array<bool, 2>, 3> shrink_wrapped{};
  double largest_radius = 0;   ///< of a particle on any rank [m]; 0 without particles
  std::optional<Vec3> gravity; ///< sum of the script's constant gravities [m/s2]
};

/// The gas grid against the simulation box: periodic directions and lengths must agree, other
/// sides, where the grid `is_box`, within one particle diameter (shrink-wrapped sides are the
/// particles' and are not compared). Throws ConfigError.
void check_box(const Scene& scene, const coupling::GridExtent& grid, bool is_box);

/// The script's gravity, if it has one, becomes that of a case that gives none. Returns a note for
/// the user where neither gives any, else an empty text. Throws ConfigError where both do and
/// differ by more than 1e-6.
std::string settle_gravity(const Scene& scene, cfd::Fluid& fluid);

} // namespace granflux::driver
