// SPDX-FileCopyrightText: 2026 The GranFlux developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <granflux/coupling/drag/drag_law.hpp>

namespace granflux::coupling {

/// Packed beds: Ergun, Chem. Eng. Prog. 48 (1952) 89-94,
///   -dp/dz = 150 (1-eps)^2 mu U / (eps^3 d^2) + 1.75 (1-eps) rho U^2 / (eps^3 d),  U = eps slip.
/// The bed bears the gradient, of which the particles' drag is the share eps (the rest, 1 - eps,
/// is the pressure gradient's own force on them), so beta slip = eps (-dp/dz) and
///   beta = 150 (1-eps)^2 mu / (eps d^2) + 1.75 (1-eps) rho |slip| / d .
/// Measured for 1 < Re/(1-eps) < 2500. No single-particle limit.
struct Ergun {
  static constexpr std::string_view name = "ergun";
  static constexpr Range valid{.reynolds = {0, 1500}, .void_fraction = {0.35, 0.8}};

  double operator()(DragInput in) const {
    const double eps = in.void_fraction;
    return (150 * (1 - eps) + 1.75 * in.reynolds) / (18 * eps * eps);
  }
};

} // namespace granflux::coupling
