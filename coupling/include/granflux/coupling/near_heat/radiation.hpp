// SPDX-FileCopyrightText: 2026 The GranFlux developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <cmath>
#include <numbers>

namespace granflux::coupling {

inline constexpr double stefan_boltzmann = 5.670374419e-8; ///< W/(m2 K4)

/// a^4 - b^4 without cancellation.
[[nodiscard]] inline double difference_of_fourth_powers(double a, double b) {
  return (a * a + b * b) * (a + b) * (a - b);
}

/// Of two parallel grey surfaces of emissivities above 0 and up to 1.
[[nodiscard]] inline double exchange_emissivity(double e_i, double e_j) {
  return 1 / (1 / e_i + 1 / e_j - 1);
}

/// Volume that two balls share [m3].
[[nodiscard]] inline double shared_volume(double radius_a, double radius_b, double distance) {
  if (distance >= radius_a + radius_b)
    return 0;
  const double small = std::min(radius_a, radius_b);
  if (distance <= std::abs(radius_a - radius_b))
    return 4. / 3 * std::numbers::pi * small * small * small;
  const double depth = radius_a + radius_b - distance, difference = radius_a - radius_b;
  return std::numbers::pi / 12 / distance * depth * depth *
         (distance * distance + 2 * distance * (radius_a + radius_b) - 3 * difference * difference);
}

/// The surroundings of a sphere end one radius off its surface: gap up to which it sees others.
[[nodiscard]] inline double sight(double radius) {
  return radius;
}

/// Surface over which two spheres see each other [m2]: that of one times the share which the other
/// has in the space around it, as far as sight goes; the lesser of the two ways round. Hence it is
/// the same for both, and adds up to no more than the surface of a sphere.
[[nodiscard]] inline double facing_area(double radius_i, double radius_j, double distance) {
  const auto of = [&](double own, double other) {
    // 4 pi R^2 / (4/3 pi ((2R)^3 - R^3)) = 3/(7R)
    return 3 / (7 * own) * shared_volume(own + sight(own), other, distance);
  };
  return std::min(of(radius_i, radius_j), of(radius_j, radius_i));
}

} // namespace granflux::coupling
