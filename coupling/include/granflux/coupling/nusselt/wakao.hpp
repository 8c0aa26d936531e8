// SPDX-FileCopyrightText: 2026 The GranFlux developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cmath>

#include <granflux/coupling/nusselt/nusselt_law.hpp>
#include <granflux/coupling/power.hpp>

namespace granflux::coupling {

/// Wakao, Kaguei, Funazkri, Chem. Eng. Science 34 (1979) 325-336: packed beds, corrected for axial
/// dispersion, Nu = 2 + 1.1 Re^0.6 Pr^1/3. Below Re = 15 an extrapolation to the limit 2.
struct Wakao {
  static constexpr std::string_view name = "wakao";
  static constexpr NusseltRange valid{.reynolds = {15, 8500}, .void_fraction = {0.35, 0.6}};

  double operator()(NusseltInput in) const {
    return 2 + 1.1 * power(in.reynolds, 0.6) * std::cbrt(in.prandtl);
  }
};

} // namespace granflux::coupling
