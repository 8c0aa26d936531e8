// SPDX-FileCopyrightText: 2026 The GranFlux developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cmath>
#include <numbers>
#include <string_view>

#include <granflux/coupling/contact_heat/cube_root.hpp>
#include <granflux/coupling/law_list.hpp>

namespace granflux::coupling {

/// What is known of a contact where its radius is asked for.
struct ContactShape {
  double force;          ///< normal, positive if it pushes [N]
  double overlap;        ///< that the true material would have [m]
  double reduced_radius; ///< ri rj / (ri + rj); at a wall the radius of the sphere [m]
  double mean_radius;    ///< geometric mean sqrt(ri rj); at a wall the radius of the sphere [m]
  double lens_squared;   ///< of the circle in which the undeformed surfaces intersect [m2]
};

/// 1/E* with E* = (4/3) / ((1-s_i^2)/E_i + (1-s_j^2)/E_j), of two materials of Young's moduli E
/// [Pa] and Poisson's ratios s; the true ones, so that a softened spring has no larger contacts.
[[nodiscard]] inline double inverse_modulus(double e_i, double s_i, double e_j, double s_j) {
  return 0.75 * ((1 - s_i * s_i) / e_i + (1 - s_j * s_j) / e_j);
}

/// Radius of the circle in which two bodies touch, by Hertz from the force: r_c = (F R*/E*)^(1/3)
/// with R* = ri rj / (ri + rj). A contact that pulls has none.
struct HertzRadius {
  static constexpr std::string_view name = "hertz";
  static constexpr bool needs_force = true;
  double operator()(double inverse_modulus, const ContactShape& c) const {
    return cube_root(c.force * c.reduced_radius * inverse_modulus);
  }
};

/// The same with R* = sqrt(ri rj), as Eq. 10 of Amritkar, Deb, Tafti (2014) has it: larger than
/// Hertz's by 2^(1/3) for equal spheres.
struct GeometricRadius {
  static constexpr std::string_view name = "geometric";
  static constexpr bool needs_force = true;
  double operator()(double inverse_modulus, const ContactShape& c) const {
    return cube_root(c.force * c.mean_radius * inverse_modulus);
  }
};

/// From the overlap, r_c = sqrt(R* delta).
struct OverlapRadius {
  static constexpr std::string_view name = "overlap";
  static constexpr bool needs_force = false;
  double operator()(double, const ContactShape& c) const {
    return std::sqrt(c.reduced_radius * c.overlap);
  }
};

/// The convention of LIGGGHTS' fix heat/gran/conduction, for comparison: the square root of the
/// area of the circle in which the undeformed spheres intersect, sqrt(2 pi) times Hertz's radius.
struct StockRadius {
  static constexpr std::string_view name = "stock";
  static constexpr bool needs_force = false;
  double operator()(double, const ContactShape& c) const {
    return std::sqrt(std::numbers::pi * c.lens_squared);
  }
};

using ContactRadii = LawList<HertzRadius, GeometricRadius, OverlapRadius, StockRadius>;
using AnyContactRadius = ContactRadii::Any;

/// Two spheres that overlap [m].
[[nodiscard]] inline ContactShape shape_of_pair(double radius_i, double radius_j, double overlap,
                                                double force) {
  const double sum = radius_i + radius_j, difference = radius_i - radius_j;
  const double square = (sum - overlap) * (sum - overlap); // of the distance
  return {.force = force,
          .overlap = overlap,
          .reduced_radius = radius_i * radius_j / sum,
          .mean_radius = std::sqrt(radius_i * radius_j),
          .lens_squared =
              overlap * (2 * sum - overlap) * (square - difference * difference) / (4 * square)};
}

/// A sphere that overlaps a wall [m].
[[nodiscard]] inline ContactShape shape_at_wall(double radius, double overlap, double force) {
  return {.force = force,
          .overlap = overlap,
          .reduced_radius = radius,
          .mean_radius = radius,
          .lens_squared = overlap * (2 * radius - overlap)};
}

} // namespace granflux::coupling
