// SPDX-FileCopyrightText: 2026 The GranFlux developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <vector>

#include <granflux/cfd/mesh.hpp>

namespace granflux::cfd {

/// One number for every cell of a mesh, for solvers that know matrices and not blocks: those of a
/// rank follow each other, block by block, i fastest.
struct CellNumbering {
  static constexpr int faces = 6; ///< of a cell: low and high along i, j, k

  explicit CellNumbering(const Mesh& mesh);

  [[nodiscard]] int of(const CellRef& ref) const {
    const Index3& n = mesh_.blocks[std::size_t(ref.block)].cells;
    return first[std::size_t(ref.block)] + ref.cell[0] + n[0] * (ref.cell[1] + n[1] * ref.cell[2]);
  }
  /// Numbers of the cells over the six faces, -1 beyond a boundary.
  [[nodiscard]] std::array<int, faces> around(int block, const Index3& cell) const;

  int cells = 0;                   ///< of all ranks
  std::vector<int> first;          ///< number of each block's first cell
  std::vector<int> counts, starts; ///< per rank: its cells, its first number

private:
  const Mesh& mesh_;
};

/// body(cell) for the cells of a block, in the order of their numbers.
template <class Body> void for_each_in_order(const Index3& cells, Body&& body) {
  for (int k = 0; k < cells[2]; ++k)
    for (int j = 0; j < cells[1]; ++j)
      for (int i = 0; i < cells[0]; ++i)
        body(Index3{i, j, k});
}

} // namespace granflux::cfd
