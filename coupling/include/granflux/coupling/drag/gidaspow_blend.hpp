// SPDX-FileCopyrightText: 2026 The GranFlux developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cmath>
#include <numbers>

#include <granflux/coupling/drag/ergun.hpp>
#include <granflux/coupling/drag/wen_yu.hpp>

namespace granflux::coupling {

/// Gidaspow without the jump: Huilin and Gidaspow, Chem. Eng. Sci. 58 (2003) 3777-3792,
///   beta = (1 - phi) beta_Ergun + phi beta_WenYu,
///   phi = 1/2 + arctan(150 * 1.75 (0.2 - (1 - eps))) / pi .
/// The arctangent leaves 0.6 % of Ergun at a void fraction of 1.
struct GidaspowBlend {
  static constexpr std::string_view name = "gidaspow_blend";
  static constexpr Range valid{.reynolds = {0, 2e5}, .void_fraction = {0.35, 1}};
  static constexpr double stokes_tolerance = 0.01;

  double operator()(DragInput in) const {
    const double phi = 0.5 + std::atan(150 * 1.75 * (in.void_fraction - 0.8)) / std::numbers::pi;
    return (1 - phi) * Ergun{}(in) + phi * WenYu{}(in);
  }
};

} // namespace granflux::coupling
