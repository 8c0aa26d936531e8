// SPDX-FileCopyrightText: 2026 The GranFlux developers
// SPDX-License-Identifier: BSD-3-Clause
#include "multigrid_level.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace granflux::cfd {

namespace {

constexpr std::size_t u(int i) {
  return std::size_t(i);
}

} // namespace

Smoothing::Smoothing(int count, double centre, double half_width) : steps(std::size_t(count) + 1) {
  if (count > 0)
    steps[1] = {0, float(1 / centre)};
  double rho = half_width / centre;
  for (std::size_t n = 2; n < steps.size(); ++n) {
    const double rho_new = 1 / (2 * centre / half_width - rho);
    steps[n] = {float(rho_new * rho), float(2 * rho_new / half_width)};
    rho = rho_new;
  }
}

Smoothing Smoothing::above(double share_left, int count) {
  constexpr double high = 2;
  const double low = high * share_left;
  return {count, (high + low) / 2, (high - low) / 2};
}

namespace {

/// How much the ratio of a cell's conductances along two directions varies over the mesh: the
/// largest over the smallest.
double spread_of_ratios(const Mesh& mesh) {
  constexpr std::array<std::array<std::size_t, 2>, 3> pairs{{{0, 1}, {0, 2}, {1, 2}}};
  // Of the logarithms: the largest ratio of each pair of directions, the largest inverse ratio.
  std::array<double, 2 * pairs.size()> most;
  most.fill(-std::numeric_limits<double>::infinity());
  for (const Block& block : mesh.local) {
    const Layout& layout = block.layout;
    for (int k = 0; k < layout.cells[2]; ++k)
      for (int j = 0; j < layout.cells[1]; ++j)
        for (int i = 0; i < layout.cells[0]; ++i) {
          const std::ptrdiff_t c = layout.at(i, j, k);
          std::array<double, 3> along{}; // mean of a cell's two faces
          for (std::size_t d = 0; d < 3; ++d)
            along[d] = block.conductance[d][c] + block.conductance[d][c + layout.stride[d]];
          for (std::size_t p = 0; p < pairs.size(); ++p) {
            const auto [d, e] = pairs[p];
            if (layout.cells[d] == 1 || layout.cells[e] == 1 || !(along[d] > 0 && along[e] > 0))
              continue; // nothing varies along a direction of one cell
            const double ratio = std::log(along[d] / along[e]);
            most[2 * p] = std::max(most[2 * p], ratio);
            most[2 * p + 1] = std::max(most[2 * p + 1], -ratio);
          }
        }
  }
  MPI_Allreduce(MPI_IN_PLACE, most.data(), int(most.size()), MPI_DOUBLE, MPI_MAX, mesh.comm);
  double spread = 0;
  for (std::size_t p = 0; p < pairs.size(); ++p)
    spread = std::max(spread, most[2 * p] + most[2 * p + 1]);
  return std::exp(spread);
}

} // namespace

Smoothing smoothing_for(const Mesh& finest) {
  // All leave about 1/12 of what they damp.
  const double spread = spread_of_ratios(finest);
  if (spread < 4)
    return Smoothing::above(1.0 / 4, 3);
  if (spread < 100)
    return Smoothing::above(1.0 / 16, 6);
  return far_reaching_smoothing();
}

Smoothing far_reaching_smoothing() {
  return Smoothing::above(1.0 / 24, 8);
}

LevelBlock::LevelBlock(Index3 cells, int outer_direction, Holds what)
    : layout(cells), rhs(layout.size), x(layout.size), inner(3 - outer_direction),
      outer(outer_direction) {
  if (what == Holds::transfer)
    return;
  for (FloatField& along : coefficient)
    along = FloatField(layout.size);
  inverse_diagonal = FloatField(layout.size);
  spare = FloatField(layout.size);
}

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

long cells_of_all_ranks(const Mesh& mesh) {
  long cells = 0;
  for (const BlockInfo& info : mesh.blocks)
    cells += long(info.cells[0]) * info.cells[1] * info.cells[2];
  return cells;
}

Level::Level(const Mesh& m, std::vector<LevelBlock> b, const Smoothing& how)
    : mesh(m), linked(is_linked(m)),
      halo(m, 1, [&](std::size_t block, const Index3& cell) { return b[block].layout.at(cell); }),
      blocks(std::move(b)), smoothing(how), exchanged_(blocks.size()) {}

Level::Level(const Mesh& finest, const Smoothing& how) : Level(finest, make_blocks(finest), how) {}
Level::Level(const Mesh& m, const Level& finer)
    : Level(m, make_blocks(m, finer), finer.smoothing) {}

Level Level::cell_by_cell(const Level& level) {
  std::vector<LevelBlock> blocks;
  for (const LevelBlock& block : level.blocks)
    blocks.emplace_back(block.layout.cells, block.outer, LevelBlock::Holds::transfer);
  Level cells(level.mesh, std::move(blocks), level.smoothing);
  cells.pairings.resize(level.mesh.blocks.size());
  return cells;
}

void Level::exchange(FloatField LevelBlock::*field) {
  if (!linked)
    return;
  for (std::size_t b = 0; b < blocks.size(); ++b)
    exchanged_[b] = (blocks[b].*field).data();
  halo.exchange(exchanged_);
}

} // namespace granflux::cfd
