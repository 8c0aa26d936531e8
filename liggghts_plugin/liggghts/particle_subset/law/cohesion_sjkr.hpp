// SPDX-FileCopyrightText: 2026 The GranFlux developers
// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

#include <numbers>
#include <string_view>

#include "../contact.hpp"
#include "../material.hpp"

namespace granflux::particle_subset {

/// Simplified Johnson-Kendall-Roberts: a pull of energy density [J/m3] times the area of the circle
/// in which the spheres intersect.
struct CohesionSjkr {
  static constexpr std::string_view name = "sjkr";
  static constexpr bool acts = true;

  struct Constants {
    double energy_density;
    double in_friction; // 1: the pull counts in the normal force that limits friction
  };
  static Constants constants(const Material& m, int a, int b) {
    return {m.pair("cohEnergyDens", a, b), double(m.option("tangential_reduce"))};
  }

  /// On i along the normal.
  static double force(const Constants& k, const Contact& c) {
    const double r = c.distance, ri = c.radius_i, rj = c.radius_j;
    const double area = -std::numbers::pi / 4 *
                        ((r - ri - rj) * (r + ri - rj) * (r - ri + rj) * (r + ri + rj)) / (r * r);
    return -k.energy_density * area;
  }
  /// Of a wall, whose plane cuts the sphere in a circle.
  static double force_of_wall(const Constants& k, const Contact& c) {
    const double area = std::numbers::pi * (c.radius_i * c.radius_i - c.distance * c.distance);
    return -k.energy_density * area;
  }
};

} // namespace granflux::particle_subset
