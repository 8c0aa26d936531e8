// SPDX-FileCopyrightText: 2026 The GranFlux developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>

#include <granflux/cfd/field.hpp>

namespace granflux::coupling {

/// A dense box of lattice cells lo <= c < hi that covers all cells which the particles of this rank
/// touch. Indices are unwrapped: beyond a periodic side they go on below 0 and past the last cell.
struct Window {
  cfd::Index3 lo{}, hi{};

  [[nodiscard]] cfd::Index3 extent() const { return {hi[0] - lo[0], hi[1] - lo[1], hi[2] - lo[2]}; }
  [[nodiscard]] std::size_t size() const {
    const auto n = extent();
    return std::size_t(n[0]) * std::size_t(n[1]) * std::size_t(n[2]);
  }
  [[nodiscard]] bool contains(const cfd::Index3& c) const {
    return c[0] >= lo[0] && c[1] >= lo[1] && c[2] >= lo[2] && c[0] < hi[0] && c[1] < hi[1] &&
           c[2] < hi[2];
  }
  /// Position of a cell in a window field: i fastest.
  [[nodiscard]] std::size_t index(const cfd::Index3& c) const {
    return std::size_t(c[0] - lo[0]) +
           std::size_t(hi[0] - lo[0]) *
               (std::size_t(c[1] - lo[1]) + std::size_t(hi[1] - lo[1]) * std::size_t(c[2] - lo[2]));
  }
  /// The cell of that position.
  [[nodiscard]] cfd::Index3 cell(std::size_t index) const {
    const auto [nx, ny, nz] = extent();
    const int i = int(index % std::size_t(nx)), rows = int(index / std::size_t(nx));
    return {lo[0] + i, lo[1] + rows % ny, lo[2] + rows / ny};
  }
};

} // namespace granflux::coupling
