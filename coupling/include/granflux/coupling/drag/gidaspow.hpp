// SPDX-FileCopyrightText: 2026 The GranFlux developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <granflux/coupling/drag/ergun.hpp>
#include <granflux/coupling/drag/wen_yu.hpp>

namespace granflux::coupling {

/// Ergun below a void fraction of 0.8, Wen and Yu from there on: Gidaspow, Multiphase Flow and
/// Fluidization (1994). F falls at 0.8, by 13 % at Re = 0, 5 % at Re = 10, 42 % at Re = 100;
/// gidaspow_blend is continuous.
struct Gidaspow {
  static constexpr std::string_view name = "gidaspow";
  static constexpr Range valid{.reynolds = {0, 2e5}, .void_fraction = {0.35, 1}};
  static constexpr double stokes_tolerance = 0;

  double operator()(DragInput in) const {
    return in.void_fraction < 0.8 ? Ergun{}(in) : WenYu{}(in);
  }
};

} // namespace granflux::coupling
