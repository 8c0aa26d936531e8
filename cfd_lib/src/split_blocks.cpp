// SPDX-FileCopyrightText: 2026 The GranFlux developers
// SPDX-License-Identifier: BSD-3-Clause
#include <granflux/cfd/split_blocks.hpp>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numeric>
#include <optional>

#include <fmt/format.h>

#include <granflux/cfd/deal_blocks.hpp>
#include <granflux/cfd/error.hpp>
#include <granflux/cfd/join_blocks.hpp>

namespace granflux::cfd {

namespace {

constexpr std::size_t u(int i) {
  return std::size_t(i);
}

Index3 extent(const IndexBox& box) {
  return {box.hi[0] - box.lo[0], box.hi[1] - box.lo[1], box.hi[2] - box.lo[2]};
}

IndexBox moved(IndexBox box, const Index3& by, int sign) {
  for (std::size_t d = 0; d < 3; ++d)
    box.lo[d] += sign * by[d], box.hi[d] += sign * by[d];
  return box;
}

/// A piece of a block: which block of the new grid it is, and its cells in the old one.
struct Piece {
  int id;
  IndexBox box;
};

/// A patch of an old block, seen by one piece and, for a link, by the piece of the donor.
Patch seen_by(const Piece& piece, Patch patch, const Piece* donor) {
  patch.cells = moved(patch.cells, piece.box.lo, -1);
  if (donor) {
    Link& link = *patch.link;
    link.block = donor->id;
    for (std::size_t a = 0; a < 3; ++a)
      link.offset[a] += link.sign[a] * piece.box.lo[u(link.axis[a])] - donor->box.lo[a];
  }
  return patch;
}

/// What a side of a piece has of the patches of its old block.
void add_outer_patches(const GridBlock& block, int old_id, const Piece& piece, const Side& side,
                       const std::vector<std::vector<Piece>>& pieces, GridBlock& out) {
  for (const Patch& patch : block.patches) {
    if (patch.side != side)
      continue;
    Patch part = patch;
    part.cells = intersection(patch.cells, piece.box);
    if (part.cells.empty())
      continue;
    if (!part.link) {
      out.patches.push_back(seen_by(piece, part, nullptr));
      continue;
    }
    const Patch beyond = answer(old_id, part);
    for (const Piece& donor : pieces[u(part.link->block)]) {
      Patch shared = beyond;
      shared.cells = intersection(beyond.cells, donor.box);
      if (!shared.cells.empty())
        out.patches.push_back(seen_by(piece, answer(part.link->block, shared), &donor));
    }
  }
}

/// The other pieces of the same block behind a side of a piece.
void add_cut_patches(int old_id, const Piece& piece, const Side& side,
                     const std::vector<Piece>& pieces, GridBlock& out) {
  const auto d = u(side.direction);
  Patch whole{side, piece.box, -1, Link{}};
  whole.link->block = old_id;
  whole.cells.lo[d] = side.high ? piece.box.hi[d] - 1 : piece.box.lo[d];
  whole.cells.hi[d] = whole.cells.lo[d] + 1;
  const Patch beyond = answer(old_id, whole);
  for (const Piece& donor : pieces) {
    Patch shared = beyond;
    shared.cells = intersection(beyond.cells, donor.box);
    if (!shared.cells.empty())
      out.patches.push_back(seen_by(piece, answer(old_id, shared), &donor));
  }
}

/// Where to cut a box so that its low part has about `wanted` cells.
struct Cut {
  int direction = 0, position = 0;
};

/// The shortest cut whose error is at most `tolerance` cells, with a premium on odd positions; else
/// the one with the least error; nothing where no direction has four cells.
std::optional<Cut> choose_cut(const IndexBox& box, double wanted, double tolerance) {
  constexpr int coarsest = 16; // multigrid levels that a cut should not get in the way of: 4
  const Index3 n = extent(box);
  std::optional<Cut> best, nearest;
  double least_cost = std::numeric_limits<double>::infinity(), least_error = least_cost;
  for (int d = 0; d < 3; ++d) {
    const double area = double(n[u((d + 1) % 3)]) * n[u((d + 2) % 3)];
    for (int step = coarsest; step >= 1; step /= 2) {
      // Multiples counted from the block's start, not the piece's, so that cuts of cuts fit too.
      const int begin = box.lo[u(d)], end = box.hi[u(d)];
      int position = step * int(std::lround((begin + wanted / area) / step));
      if (step == 1 && end - begin >= 4)
        position = std::clamp(position, begin + 2, end - 2);
      if (position < begin + 2 || position > end - 2)
        continue;
      const double error = std::abs((position - begin) * area - wanted);
      const double cost = area * (1 + 1.0 / step);
      if (error <= tolerance && cost < least_cost)
        least_cost = cost, best = {d, position};
      if (error < least_error)
        least_error = error, nearest = {d, position};
    }
  }
  return best ? best : nearest;
}

/// Cuts a box into parts of about the given cells, in their order; false where it cannot be.
bool cut(const IndexBox& box, const std::vector<double>& parts, double tolerance,
         std::vector<IndexBox>& out) {
  if (parts.size() == 1) {
    out.push_back(box);
    return true;
  }
  const double sum = std::accumulate(parts.begin(), parts.end(), 0.0);
  // The first group of parts is as near to half as can be.
  std::size_t middle = 1;
  double low = parts[0];
  while (middle + 1 < parts.size() &&
         std::abs(low + parts[middle] - sum / 2) < std::abs(low - sum / 2))
    low += parts[middle++];
  const double wanted = low / sum * double(cell_count(extent(box)));
  const std::optional<Cut> where = choose_cut(box, wanted, tolerance);
  if (!where)
    return false;
  IndexBox first = box, second = box;
  first.hi[u(where->direction)] = second.lo[u(where->direction)] = where->position;
  const auto split = parts.begin() + std::ptrdiff_t(middle);
  return cut(first, {parts.begin(), split}, tolerance, out) &&
         cut(second, {split, parts.end()}, tolerance, out);
}

std::vector<std::int64_t> costs(const Grid& grid) {
  std::vector<std::int64_t> cost;
  for (const GridBlock& block : grid.blocks)
    cost.push_back(cell_count(block.cells));
  return cost;
}

double imbalance_of(const Grid& grid, int ranks) {
  const std::vector<std::int64_t> cost = costs(grid);
  return imbalance(cost, deal_blocks(cost, ranks), ranks);
}

} // namespace

Grid split_blocks(const Grid& grid, const Pieces& boxes) {
  std::vector<std::vector<Piece>> pieces(grid.blocks.size());
  int count = 0;
  for (std::size_t b = 0; b < grid.blocks.size(); ++b)
    for (const IndexBox& box : boxes[b])
      pieces[b].push_back({count++, box});

  Grid split;
  split.boundaries = grid.boundaries;
  for (std::size_t b = 0; b < grid.blocks.size(); ++b) {
    const GridBlock& block = grid.blocks[b];
    for (const Piece& piece : pieces[b]) {
      GridBlock out;
      const Index3 lo = piece.box.lo;
      out.cells = extent(piece.box);
      out.name = out.cells == block.cells
                     ? block.name
                     : fmt::format("{} from ({}, {}, {})", block.name, lo[0], lo[1], lo[2]);
      const Place place = block.place.value_or(Place{.block = int(b), .low = {}});
      out.place = {place.block, {place.low[0] + lo[0], place.low[1] + lo[1], place.low[2] + lo[2]}};
      out.node = [node = block.node, lo](int i, int j, int k) {
        return node(lo[0] + i, lo[1] + j, lo[2] + k);
      };
      for (int d = 0; d < 3; ++d)
        for (const bool high : {false, true}) {
          const bool outer = high ? piece.box.hi[u(d)] == block.cells[u(d)] : lo[u(d)] == 0;
          if (outer)
            add_outer_patches(block, int(b), piece, {d, high}, pieces, out);
          else
            add_cut_patches(int(b), piece, {d, high}, pieces[b], out);
        }
      split.blocks.push_back(std::move(out));
    }
  }
  return split;
}

std::optional<Pieces> choose_pieces(const Grid& grid, int ranks) {
  const std::vector<std::int64_t> cost = costs(grid);
  const double mean =
      double(std::accumulate(cost.begin(), cost.end(), std::int64_t{0})) / double(ranks);
  // A share that ends this near to the edge of a block ends there; a cut may miss its place by
  // that.
  const double near = 0.04 * mean, tolerance = 0.02 * mean;
  Pieces pieces;
  double begin = 0;
  for (std::size_t b = 0; b < cost.size(); ++b) {
    const double end = begin + double(cost[b]);
    std::vector<double> parts;
    double last = begin;
    for (int rank = 1; rank < ranks; ++rank) {
      const double share_end = mean * rank;
      if (share_end <= begin + near || share_end >= end - near)
        continue;
      parts.push_back(share_end - last);
      last = share_end;
    }
    parts.push_back(end - last);
    std::vector<IndexBox> boxes;
    if (!cut({{0, 0, 0}, grid.blocks[b].cells}, parts, tolerance, boxes))
      return {};
    pieces.push_back(std::move(boxes));
    begin = end;
  }
  return pieces;
}

Grid split_for_ranks(const Grid& grid, int ranks) {
  constexpr double good = 1.1;
  const bool enough = int(grid.blocks.size()) >= ranks;
  const double whole = enough ? imbalance_of(grid, ranks) : std::numeric_limits<double>::infinity();
  if (whole <= good)
    return grid;
  const std::optional<Pieces> pieces = choose_pieces(grid, ranks);
  if (!pieces && !enough)
    throw ConfigError(fmt::format(
        "grid: {} blocks cannot be cut into pieces for {} ranks with at least two cells along each "
        "direction that is cut: use fewer ranks or more cells",
        grid.blocks.size(), ranks));
  if (!pieces)
    return grid;
  Grid split = split_blocks(grid, *pieces);
  return imbalance_of(split, ranks) < whole ? split : grid;
}

} // namespace granflux::cfd
