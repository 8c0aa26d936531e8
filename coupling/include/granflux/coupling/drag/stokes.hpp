// SPDX-FileCopyrightText: 2026 The GranFlux developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <granflux/coupling/drag/drag_law.hpp>

namespace granflux::coupling {

/// Creeping flow past one sphere: Stokes, Trans. Camb. Phil. Soc. 9 (1851) 8-106.
struct Stokes {
  static constexpr std::string_view name = "stokes";
  static constexpr Range valid{.reynolds = {0, 0.1}, .void_fraction = {0.95, 1}};
  static constexpr double stokes_tolerance = 0;

  double operator()(DragInput) const { return 1; }
};

} // namespace granflux::coupling
