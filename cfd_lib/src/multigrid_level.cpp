// SPDX-FileCopyrightText: 2026 The GranFlux developers
// SPDX-License-Identifier: BSD-3-Clause
#include "multigrid_level.hpp"

#include <utility>

namespace granflux::cfd {

namespace {

constexpr std::size_t u(int i) {
  return std::size_t(i);
}

} // namespace

LevelBlock::LevelBlock(Index3 cells, int outer_direction)
    : layout(cells), coefficient{FloatField(layout.size), FloatField(layout.size),
                                 FloatField(layout.size)},
      inverse_diagonal(layout.size), rhs(layout.size), x(layout.size), spare(layout.size),
      inner(3 - outer_direction), outer(outer_direction) {}

namespace {

bool is_linked(const Mesh& mesh) {
  for (int id = 0; id < int(mesh.blocks.size()); ++id)
    for (const Patch& patch : mesh.blocks[u(id)].patches)
      if (patch.link && !closed_on_itself(mesh, id, patch.side.direction))
        return true;
  return false;
}

/// The longer one of j and k, so that planes are small. On a lattice that of the whole box: sums
/// then run in the same order however the box is cut.
std::vector<LevelBlock> make_blocks(const Mesh& mesh) {
  std::vector<LevelBlock> blocks;
  for (const Block& block : mesh.local) {
    const Index3 of = mesh.lattice ? mesh.lattice->cells() : block.layout.cells;
    blocks.emplace_back(block.layout.cells, of[2] >= of[1] ? 2 : 1);
  }
  return blocks;
}

std::vector<LevelBlock> make_blocks(const Mesh& mesh, const Level& finer) {
  std::vector<LevelBlock> blocks;
  for (std::size_t b = 0; b < mesh.local.size(); ++b)
    blocks.emplace_back(mesh.local[b].layout.cells, finer.blocks[b].outer);
  return blocks;
}

} // namespace

Level::Level(const Mesh& m, std::vector<LevelBlock> b)
    : mesh(m), linked(is_linked(m)),
      halo(m, 1, [&](std::size_t block, const Index3& cell) { return b[block].layout.at(cell); }),
      blocks(std::move(b)), exchanged_(blocks.size()) {}

Level::Level(const Mesh& finest) : Level(finest, make_blocks(finest)) {}
Level::Level(const Mesh& m, const Level& finer) : Level(m, make_blocks(m, finer)) {}

void Level::exchange(FloatField LevelBlock::*field) {
  if (!linked)
    return;
  for (std::size_t b = 0; b < blocks.size(); ++b)
    exchanged_[b] = (blocks[b].*field).data();
  halo.exchange(exchanged_);
}

} // namespace granflux::cfd
