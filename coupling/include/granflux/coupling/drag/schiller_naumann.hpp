// SPDX-FileCopyrightText: 2026 The GranFlux developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <granflux/coupling/drag/drag_law.hpp>
#include <granflux/coupling/power.hpp>

namespace granflux::coupling {

/// One sphere, no neighbours: Schiller and Naumann, Z. Ver. Deutsch. Ing. 77 (1935) 318-320,
/// Cd = 24/Re (1 + 0.15 Re^0.687) below Re = 1000; Newton's Cd = 0.44 from there to the drag
/// crisis. F = Cd Re / 24.
struct SchillerNaumann {
  static constexpr std::string_view name = "schiller_naumann";
  static constexpr Range valid{.reynolds = {0, 2e5}, .void_fraction = {0.95, 1}};
  static constexpr double stokes_tolerance = 0;

  double operator()(DragInput in) const {
    const double re = in.reynolds;
    return re < 1000 ? 1 + 0.15 * power(re, 0.687) : 0.44 / 24 * re;
  }
};

} // namespace granflux::coupling
