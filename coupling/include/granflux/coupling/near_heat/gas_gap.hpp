// SPDX-FileCopyrightText: 2026 The GranFlux developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <cmath>
#include <numbers>

namespace granflux::coupling {

/// Conduction from sphere to sphere through the gas at rest in the gap between them, along lines
/// parallel to that of the centres, as far out as the layer of gas around the larger sphere meets
/// the surface of the smaller (Rong and Horio, 2nd Int. Conf. on CFD in the Minerals and Process
/// Industries, Melbourne (1999) 65-70; a layer in parts of the radius as in MFIX). Its integral
/// over the gap has a closed form for any two radii (docs/theory_heat.md).
struct GasGap {
  double conductivity;        ///< of the gas [W/(m K)]
  double layer = 0.2;         ///< thickness over the radius of the larger sphere, above 0
  double least_gap = 2.75e-8; ///< surfaces count as no nearer: molecules, roughness [m]

  /// Gap up to which a sphere of that radius conducts to one as large or smaller [m].
  [[nodiscard]] double reach(double radius) const { return layer * radius; }

  /// [W/K], 0 from the reach on; continuous there. Symmetric to the last bit. Radii and distance of
  /// the centres [m].
  [[nodiscard]] double conductance(double radius_i, double radius_j, double distance) const;
};

/// Integral of r dr / (distance - s), where s(r) = sqrt(R_i^2 - r^2) + sqrt(R_j^2 - r^2), from
/// s = inner outwards to s = outer < inner. `difference`: of the squared radii, not negative.
[[nodiscard]] inline double gap_integral(double inner, double outer, double distance,
                                         double difference) {
  const double ratio = difference / (distance * distance);
  double integral =
      outer - inner +
      distance * (1 - ratio * ratio) * std::log((distance - outer) / (distance - inner));
  if (difference > 0)
    integral -= ratio * difference *
                (0.5 * distance * (1 / (outer * outer) - 1 / (inner * inner)) + 1 / outer -
                 1 / inner + std::log(inner / outer) / distance);
  return 0.25 * integral;
}

inline double GasGap::conductance(double radius_i, double radius_j, double distance) const {
  const double large = std::max(radius_i, radius_j), small = std::min(radius_i, radius_j);
  const double edge = (1 + layer) * large;
  if (distance >= edge + small)
    return 0;
  const double difference = large * large - small * small;
  // The edge of the layer cuts the small sphere in a circle at this height above its centre, or
  // reaches past its equator.
  const double height =
      std::max(0.0, (distance * distance + small * small - edge * edge) / (2 * distance));
  const double outer = height + std::sqrt(difference + height * height);
  const double inner = std::min(large + small, distance);
  const double flat = std::max(outer, std::min(inner, distance - least_gap)); // from there inwards
  const auto off_line_squared = [&](double sum) {
    const double height_on_large = 0.5 * (sum + difference / sum);
    return large * large - height_on_large * height_on_large;
  };
  const double area = off_line_squared(flat) - off_line_squared(inner); // over pi
  const double widening = flat > outer ? gap_integral(flat, outer, distance, difference) : 0;
  return std::numbers::pi * conductivity * (area / least_gap + 2 * widening);
}

} // namespace granflux::coupling
