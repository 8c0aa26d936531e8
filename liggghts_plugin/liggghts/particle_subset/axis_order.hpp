// SPDX-FileCopyrightText: 2026 The GranFlux developers
// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

#include <algorithm>
#include <array>
#include <cmath>

namespace granflux::particle_subset {

/// The three axes by the lengths of a box along them, the shortest first. Lengths count in cells of
/// `size` and in steps of a half octave: beds as long as wide do not turn round each time.
template <class Lengths>
[[nodiscard]] std::array<int, 3> axis_order(const Lengths& lengths, double size) {
  const auto rank = [&](int d) { return std::lround(2 * std::log2(lengths[d] / size + 1)); };
  std::array<int, 3> axes{0, 1, 2};
  std::stable_sort(axes.begin(), axes.end(), [&](int a, int b) { return rank(a) < rank(b); });
  return axes;
}

} // namespace granflux::particle_subset
