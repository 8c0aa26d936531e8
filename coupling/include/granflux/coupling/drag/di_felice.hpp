// SPDX-FileCopyrightText: 2026 The GranFlux developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <cmath>
#include <numbers>

#include <granflux/coupling/drag/drag_law.hpp>
#include <granflux/coupling/power.hpp>

namespace granflux::coupling {

/// Di Felice, Int. J. Multiphase Flow 20 (1994) 153-159: the drag of a single sphere at the
/// superficial slip (Dallavalle's Cd = (0.63 + 4.8 Re^-1/2)^2) times eps^-chi,
///   drag = 1/8 Cd rho pi d^2 (eps slip)^2 eps^-chi,
///   chi = 3.7 - 0.65 exp(-(1.5 - log10 Re)^2 / 2) .
/// Divided by 3 pi mu d eps slip: F = Cd Re / 24 eps^-chi. F is not monotone in Re in dense beds.
struct DiFelice {
  static constexpr std::string_view name = "di_felice";
  static constexpr Range valid{.reynolds = {0, 1e4}, .void_fraction = {0.4, 1}};
  static constexpr double stokes_tolerance = 0.05; // Dallavalle: 4.8^2 / 24 = 0.96

  double operator()(DragInput in) const {
    const double root = 0.63 * std::sqrt(in.reynolds) + 4.8; // = sqrt(Cd Re)
    // Below Re = 1e-30 chi is 3.7 to the last bit; this only keeps the logarithm finite.
    const double s =
        1.5 - std::numbers::ln2 / std::numbers::ln10 * logarithm2(std::max(in.reynolds, 1e-30));
    const double chi = 3.7 - 0.65 * exponential2(-0.5 / std::numbers::ln2 * s * s);
    return root * root / 24 * power(in.void_fraction, -chi);
  }
};

} // namespace granflux::coupling
