// SPDX-FileCopyrightText: 2026 The GranFlux developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cmath>

#include <granflux/coupling/nusselt/nusselt_law.hpp>

namespace granflux::coupling {

/// Ranz and Marshall, Chem. Eng. Progress 48 (1952) 141-146, 173-180: a single sphere,
/// Nu = 2 + 0.6 Re^1/2 Pr^1/3.
struct RanzMarshall {
  static constexpr std::string_view name = "ranz_marshall";
  static constexpr NusseltRange valid{.reynolds = {0, 1e4}, .void_fraction = {0.95, 1}};

  double operator()(NusseltInput in) const {
    return 2 + 0.6 * std::sqrt(in.reynolds) * std::cbrt(in.prandtl);
  }
};

} // namespace granflux::coupling
