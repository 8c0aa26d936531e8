// SPDX-FileCopyrightText: 2026 The GranFlux developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cmath>

#include <granflux/coupling/nusselt/nusselt_law.hpp>
#include <granflux/coupling/power.hpp>

namespace granflux::coupling {

/// Gunn, Int. J. Heat Mass Transfer 21 (1978) 467-476: packed and fluidised beds and single
/// spheres, by one polynomial in the void fraction.
struct Gunn {
  static constexpr std::string_view name = "gunn";
  static constexpr NusseltRange valid{.reynolds = {0, 1e5}, .void_fraction = {0.35, 1}};

  double operator()(NusseltInput in) const {
    const double eps = in.void_fraction;
    const double root = std::cbrt(in.prandtl);
    return (7 - 10 * eps + 5 * eps * eps) * (1 + 0.7 * power(in.reynolds, 0.2) * root) +
           (1.33 - 2.4 * eps + 1.2 * eps * eps) * power(in.reynolds, 0.7) * root;
  }
};

} // namespace granflux::coupling
