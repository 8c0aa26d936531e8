// SPDX-FileCopyrightText: 2026 The GranFlux developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstddef>
#include <vector>

namespace granflux::cfd {

/// Layers of ghost cells around every block: two, for second-order upwind stencils.
inline constexpr int ghost_layers = 2;

using Index3 = std::array<int, 3>;

/// Where the cells of one block lie in memory: i fastest, ghost layers on every side.
///
/// A quantity on faces normal to direction d uses the same layout: entry c is the low face of
/// cell c, entry c + stride[d] its high face.
struct Layout {
  Index3 cells{};                         ///< interior cells along i, j, k
  std::array<std::ptrdiff_t, 3> stride{}; ///< distance in memory of neighbours along i, j, k
  std::ptrdiff_t origin = 0;              ///< position of interior cell (0,0,0)
  std::size_t size = 0;                   ///< entries, ghosts included

  Layout() = default;
  explicit Layout(Index3 n)
      : cells(n), stride{1, n[0] + 2 * ghost_layers,
                         std::ptrdiff_t(n[0] + 2 * ghost_layers) * (n[1] + 2 * ghost_layers)} {
    origin = ghost_layers * (stride[0] + stride[1] + stride[2]);
    size = std::size_t(stride[2]) * std::size_t(n[2] + 2 * ghost_layers);
  }
  /// Position of cell (i,j,k); interior for 0 <= i < cells[0], ghosts down to -2 and up to +1.
  [[nodiscard]] std::ptrdiff_t at(int i, int j, int k) const {
    return origin + i + j * stride[1] + k * stride[2];
  }
  [[nodiscard]] std::ptrdiff_t at(const Index3& c) const { return at(c[0], c[1], c[2]); }
  [[nodiscard]] std::ptrdiff_t interior() const {
    return std::ptrdiff_t(cells[0]) * cells[1] * cells[2];
  }
};

/// One scalar on the cells (or on the faces of one direction) of one block.
class Field {
public:
  Field() = default;
  explicit Field(const Layout& layout, double value = 0) : values_(layout.size, value) {}

  double& operator[](std::ptrdiff_t c) { return values_[std::size_t(c)]; }
  double operator[](std::ptrdiff_t c) const { return values_[std::size_t(c)]; }
  double* data() { return values_.data(); }
  const double* data() const { return values_.data(); }
  [[nodiscard]] std::size_t size() const { return values_.size(); }
  void fill(double value) { values_.assign(values_.size(), value); }

private:
  std::vector<double> values_;
};

/// Cartesian components of a vector on the cells of one block.
using VectorField = std::array<Field, 3>;

/// A quantity on all blocks that this rank owns, in the order of Mesh::local.
using BlockFields = std::vector<Field>;
using BlockVectors = std::vector<VectorField>;

} // namespace granflux::cfd
