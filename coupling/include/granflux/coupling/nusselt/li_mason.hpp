// SPDX-FileCopyrightText: 2026 The GranFlux developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cmath>

#include <granflux/coupling/nusselt/nusselt_law.hpp>
#include <granflux/coupling/power.hpp>

namespace granflux::coupling {

/// Li and Mason, Powder Technology 112 (2000) 273-282: pneumatic transport, with the factor
/// eps^3.5 for particles of about 1 mm. It jumps by 0.3 % of Nu - 2 at Re = 200 and by less at
/// Re = 1500, where the Prandtl number is that of air.
struct LiMason {
  static constexpr std::string_view name = "li_mason";
  static constexpr NusseltRange valid{.reynolds = {0, 1e5}, .void_fraction = {0.7, 1}};

  double operator()(NusseltInput in) const {
    const double re = in.reynolds, root = std::cbrt(in.prandtl);
    const double crowding = power(in.void_fraction, 3.5);
    if (re <= 200)
      return 2 + 0.6 * crowding * std::sqrt(re) * root;
    if (re <= 1500)
      return 2 + crowding * root * (0.5 * std::sqrt(re) + 0.02 * power(re, 0.8));
    return 2 + 4.5e-5 * crowding * power(re, 1.8);
  }
};

} // namespace granflux::coupling
