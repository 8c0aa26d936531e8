// SPDX-FileCopyrightText: 2026 The GranFlux developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstddef>

#include <granflux/cfd/field.hpp>

namespace granflux::coupling {

/// Shares of a point in n cells one after the other along a direction. They sum to 1: that of cell
/// `rest` is what the others leave, and only these are kept.
template <int n> struct CellRow {
  static constexpr std::size_t rest = (n - 1) / 2;
  using Others = std::array<double, std::size_t(n - 1)>;
  using All = std::array<double, std::size_t(n)>;

  int lowest = 0; ///< first cell, unwrapped
  Others others{};

  [[nodiscard]] static All all(const Others& others) {
    All shares{};
    double left = 1;
    for (std::size_t c = 0; c < others.size(); ++c) {
      shares[c < rest ? c : c + 1] = others[c];
      left -= others[c];
    }
    shares[rest] = left;
    return shares;
  }
};

/// The same in n x n x n cells: products of the shares along x, y, z.
template <int n> struct CellCube {
  cfd::Index3 lowest;
  std::array<typename CellRow<n>::Others, 3> others;
};

} // namespace granflux::coupling
