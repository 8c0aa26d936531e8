// SPDX-FileCopyrightText: 2026 The GranFlux developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

namespace granflux::coupling {

struct Interval {
  double low = 0, high = 0; ///< both included
  [[nodiscard]] constexpr bool contains(double x) const { return low <= x && x <= high; }
};

} // namespace granflux::coupling
