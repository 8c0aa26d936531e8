// SPDX-FileCopyrightText: 2026 The GranFlux developers
// SPDX-License-Identifier: BSD-3-Clause
#include "cell_numbering.hpp"

namespace granflux::cfd {

CellNumbering::CellNumbering(const Mesh& mesh) : first(mesh.blocks.size()), mesh_(mesh) {
  int ranks = 1;
  MPI_Comm_size(mesh.comm, &ranks);
  for (int rank = 0; rank < ranks; ++rank) {
    starts.push_back(cells);
    for (std::size_t id = 0; id < mesh.blocks.size(); ++id)
      if (mesh.blocks[id].rank == rank) {
        first[id] = cells;
        cells += mesh.blocks[id].cells[0] * mesh.blocks[id].cells[1] * mesh.blocks[id].cells[2];
      }
    counts.push_back(cells - starts.back());
  }
}

std::array<int, CellNumbering::faces> CellNumbering::around(int block, const Index3& cell) const {
  std::array<int, faces> numbers{};
  for (std::size_t f = 0; f < faces; ++f) {
    Index3 c = cell;
    c[f / 2] += f % 2 ? 1 : -1;
    const auto there = resolve(mesh_, {block, c});
    numbers[f] = there ? of(*there) : -1;
  }
  return numbers;
}

} // namespace granflux::cfd
