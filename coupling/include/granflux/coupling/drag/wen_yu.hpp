// SPDX-FileCopyrightText: 2026 The GranFlux developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <granflux/coupling/drag/schiller_naumann.hpp>
#include <granflux/coupling/power.hpp>

namespace granflux::coupling {

/// Wen and Yu, Chem. Eng. Prog. Symp. Ser. 62 (1966) 100-111, as in Gidaspow, Multiphase Flow and
/// Fluidization (1994): the drag of a single sphere at the superficial slip, times a power of the
/// void fraction,
///   beta = 3/4 Cd eps (1 - eps) rho |slip| / d eps^-2.65 .
/// With Cd Re / 24 = F_single and Re = rho eps |slip| d / mu this is F = F_single eps^-3.65. (The
/// original's exponent -4.7 is for the force that holds a suspended particle against its weight
/// less static buoyancy; the drag of model A is the share eps of that.)
struct WenYu {
  static constexpr std::string_view name = "wen_yu";
  static constexpr Range valid{.reynolds = {0, 2e5}, .void_fraction = {0.4, 1}};
  static constexpr double stokes_tolerance = 0;

  double operator()(DragInput in) const {
    return SchillerNaumann{}(in)*power(in.void_fraction, -3.65);
  }
};

} // namespace granflux::coupling
