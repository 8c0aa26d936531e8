// SPDX-FileCopyrightText: 2026 The GranFlux developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cmath>
#include <numbers>

#include <granflux/coupling/drag/drag_law.hpp>
#include <granflux/coupling/power.hpp>

namespace granflux::coupling {

/// Lattice-Boltzmann simulations of random arrays of equal spheres ("BVK"): Beetstra, van der Hoef
/// and Kuipers, AIChE J. 53 (2007) 489-501. With phi = 1 - eps and the superficial Re of DragInput
///   F = 10 phi/eps^2 + eps^2 (1 + 1.5 sqrt(phi))
///     + 0.413 Re/(24 eps^2) (1/eps + 3 eps phi + 8.4 Re^-0.343) / (1 + 10^(3 phi) Re^-(1+4 phi)/2)
///     .
/// Their F already leaves the mean pressure gradient out, beta = 18 mu eps phi F / d^2, unlike
/// Koch and Hill's (at Re = 0 and high phi both give 10 phi/eps^2). Simulated for 0.1 <= phi <= 0.6
/// and Re <= 1000; built to meet the single sphere at phi = 0.
struct Beetstra {
  static constexpr std::string_view name = "beetstra";
  static constexpr Range valid{.reynolds = {0, 1000}, .void_fraction = {0.4, 1}};
  static constexpr double stokes_tolerance = 0;

  double operator()(DragInput in) const {
    const double re = in.reynolds, eps = in.void_fraction, phi = 1 - eps;
    const double viscous = 10 * phi / (eps * eps) + eps * eps * (1 + 1.5 * std::sqrt(phi));
    // Numerator and denominator times Re^m: finite at Re = 0.
    const double re_m = power(re, 0.5 + 2 * phi);
    const double inertial = 0.413 / (24 * eps * eps) * re_m *
                            ((1 / eps + 3 * eps * phi) * re + 8.4 * power(re, 1 - 0.343)) /
                            (re_m + exponential2(3 * std::numbers::ln10 / std::numbers::ln2 * phi));
    return viscous + inertial;
  }
};

} // namespace granflux::coupling
