// SPDX-FileCopyrightText: 2026 The GranFlux developers
// SPDX-License-Identifier: BSD-3-Clause
#include <granflux/cfd/box_mesh.hpp>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>

#include <granflux/cfd/error.hpp>

namespace granflux::cfd {

namespace {

constexpr std::size_t u(int i) {
  return std::size_t(i);
}

std::string side_name(const Side& side) {
  return std::string(1, "xyz"[side.direction]) + (side.high ? "_high" : "_low");
}

/// Blocks along each direction with `pieces` in all, the least area between them and at least two
/// cells in each; nothing fits: ConfigError.
Index3 choose_blocks(const Index3& cells, int pieces) {
  Index3 best{0, 0, 0};
  double least = std::numeric_limits<double>::infinity();
  for (int a = 1; a <= pieces; ++a)
    for (int b = 1; a * b <= pieces; ++b) {
      if (pieces % (a * b) != 0)
        continue;
      const Index3 n{a, b, pieces / (a * b)};
      double area = 0;
      bool fits = true;
      for (int d = 0; d < 3; ++d) {
        fits = fits && (n[u(d)] == 1 || cells[u(d)] >= 2 * n[u(d)]);
        area += double(n[u(d)] - 1) * cells[u((d + 1) % 3)] * cells[u((d + 2) % 3)];
      }
      if (fits && area < least)
        least = area, best = n;
    }
  if (best[0] == 0)
    throw ConfigError("[grid] cells = [" + std::to_string(cells[0]) + ", " +
                      std::to_string(cells[1]) + ", " + std::to_string(cells[2]) +
                      "]: cannot be cut into one block a rank for " + std::to_string(pieces) +
                      " ranks with at least two cells a block and direction: use fewer ranks or "
                      "more cells");
  return best;
}

/// Cell range of a patch on its side of the whole box.
IndexBox covered(const BoxGrid& grid, const BoxPatch& patch, const Index3& cells) {
  IndexBox box{{0, 0, 0}, cells};
  const int normal = patch.side.direction;
  for (int d = 0; d < 3; ++d) {
    if (d == normal)
      continue;
    int lo = cells[u(d)], hi = 0;
    for (int c = 0; c < cells[u(d)]; ++c) {
      const double centre = 0.5 * (grid.nodes[u(d)][u(c)] + grid.nodes[u(d)][u(c + 1)]);
      if (centre >= patch.from[d] && centre <= patch.to[d])
        lo = std::min(lo, c), hi = c + 1;
    }
    box.lo[u(d)] = lo, box.hi[u(d)] = hi;
  }
  box.lo[u(normal)] = patch.side.high ? cells[u(normal)] - 1 : 0;
  box.hi[u(normal)] = box.lo[u(normal)] + 1;
  return box;
}

std::int64_t faces(const IndexBox& b) {
  return b.empty() ? 0
                   : std::int64_t(b.hi[0] - b.lo[0]) * (b.hi[1] - b.lo[1]) * (b.hi[2] - b.lo[2]);
}

/// Every face of every side belongs to exactly one patch, or the side is periodic.
void check_patches(const BoxGrid& grid, const std::vector<IndexBox>& boxes, const Index3& cells) {
  std::array<std::array<std::int64_t, 2>, 3> bare{};
  for (int d = 0; d < 3; ++d)
    bare[u(d)].fill(std::int64_t(cells[u((d + 1) % 3)]) * cells[u((d + 2) % 3)]);
  for (std::size_t a = 0; a < boxes.size(); ++a) {
    const BoxPatch& patch = grid.patches[a];
    if (grid.periodic[u(patch.side.direction)])
      throw ConfigError("boundary \"" + patch.name + "\": its side " + side_name(patch.side) +
                        " is periodic: remove the boundary, or set periodic to false there");
    if (faces(boxes[a]) == 0)
      throw ConfigError("boundary \"" + patch.name + "\": no face of side " +
                        side_name(patch.side) + " has its centre between `from` and `to`");
    for (std::size_t b = 0; b < a; ++b)
      if (grid.patches[b].side == patch.side && faces(intersection(boxes[a], boxes[b])) > 0)
        throw ConfigError(
            "boundaries \"" + grid.patches[b].name + "\" and \"" + patch.name + "\" overlap on " +
            std::to_string(faces(intersection(boxes[a], boxes[b]))) + " faces of side " +
            side_name(patch.side) +
            ": each face takes one boundary; give each its own rectangle by `from` and `to`");
    bare[u(patch.side.direction)][patch.side.high] -= faces(boxes[a]);
  }
  for (int d = 0; d < 3; ++d)
    for (const bool high : {false, true})
      if (!grid.periodic[u(d)] && bare[u(d)][high] > 0)
        throw ConfigError("side " + side_name({d, high}) + ": " + std::to_string(bare[u(d)][high]) +
                          " faces have no boundary: add a [[boundary]] for them, or make the "
                          "direction periodic");
}

} // namespace

std::vector<double> uniform_nodes(double origin, double length, int n) {
  std::vector<double> nodes(u(n + 1));
  for (int i = 0; i <= n; ++i)
    nodes[u(i)] = i < n ? origin + length * i / n : origin + length;
  return nodes;
}

Mesh make_box_mesh(const BoxGrid& box, MPI_Comm comm) {
  int ranks = 1;
  MPI_Comm_size(comm, &ranks);

  Lattice lattice{box.nodes, box.periodic, {}};
  for (int d = 0; d < 3; ++d) {
    const auto& nodes = box.nodes[u(d)];
    if (nodes.size() < 2 || !std::is_sorted(nodes.begin(), nodes.end(), std::less_equal<>()))
      throw ConfigError(std::string("[grid]: node coordinates along ") + "xyz"[d] +
                        " must be at least two and increase strictly");
  }
  const Index3 cells = lattice.cells();
  Index3 blocks = box.blocks;
  if (blocks[0] <= 0)
    blocks = choose_blocks(cells, ranks);
  for (int d = 0; d < 3; ++d) {
    const int n = blocks[u(d)];
    if (n < 1 || (n > 1 && cells[u(d)] < 2 * n))
      throw ConfigError("[grid] blocks: " + std::to_string(n) + " along " + "xyz"[d] + " with " +
                        std::to_string(cells[u(d)]) +
                        " cells: at least 1 block, and at least 2 cells in each");
    for (int s = 0; s <= n; ++s)
      lattice.starts[u(d)].push_back(int(std::int64_t(cells[u(d)]) * s / n));
  }
  const int count = blocks[0] * blocks[1] * blocks[2];
  if (count < ranks)
    throw ConfigError("[grid] blocks: " + std::to_string(count) + " blocks for " +
                      std::to_string(ranks) + " ranks: every rank needs at least one block");

  Grid grid;
  std::vector<IndexBox> covers;
  for (const BoxPatch& patch : box.patches) {
    covers.push_back(covered(box, patch, cells));
    if (std::find(grid.boundaries.begin(), grid.boundaries.end(), patch.name) !=
        grid.boundaries.end())
      throw ConfigError("boundary \"" + patch.name + "\" is given twice: names must differ");
    grid.boundaries.push_back(patch.name);
  }
  check_patches(box, covers, cells);

  for (int id = 0; id < count; ++id) {
    const Index3 slab{id % blocks[0], id / blocks[0] % blocks[1], id / (blocks[0] * blocks[1])};
    IndexBox mine;
    GridBlock block;
    for (int d = 0; d < 3; ++d) {
      mine.lo[u(d)] = lattice.starts[u(d)][u(slab[u(d)])];
      mine.hi[u(d)] = lattice.starts[u(d)][u(slab[u(d)] + 1)];
      block.cells[u(d)] = mine.hi[u(d)] - mine.lo[u(d)];
    }
    block.place = {0, mine.lo};
    block.node = [nodes = box.nodes, lo = mine.lo](int i, int j, int k) {
      return Vec3{nodes[0][u(lo[0] + i)], nodes[1][u(lo[1] + j)], nodes[2][u(lo[2] + k)]};
    };
    for (int d = 0; d < 3; ++d)
      for (const bool high : {false, true}) {
        IndexBox layer{{0, 0, 0}, block.cells};
        layer.lo[u(d)] = high ? block.cells[u(d)] - 1 : 0;
        layer.hi[u(d)] = layer.lo[u(d)] + 1;
        const int beyond = slab[u(d)] + (high ? 1 : -1);
        const bool inside = beyond >= 0 && beyond < blocks[u(d)];
        if (inside || box.periodic[u(d)]) {
          Index3 other = slab;
          other[u(d)] = (beyond + blocks[u(d)]) % blocks[u(d)];
          Link link;
          link.block = lattice.block(other);
          const auto& starts = lattice.starts[u(d)];
          link.offset[u(d)] =
              high ? -block.cells[u(d)] : starts[u(other[u(d)] + 1)] - starts[u(other[u(d)])];
          if (!inside)
            link.shift[d] = (high ? 1 : -1) * (box.nodes[u(d)].back() - box.nodes[u(d)].front());
          block.patches.push_back({{d, high}, layer, -1, link});
          continue;
        }
        for (std::size_t p = 0; p < covers.size(); ++p) {
          if (box.patches[p].side != Side{d, high})
            continue;
          IndexBox shared = intersection(covers[p], mine);
          if (shared.empty())
            continue;
          for (int e = 0; e < 3; ++e)
            shared.lo[u(e)] -= mine.lo[u(e)], shared.hi[u(e)] -= mine.lo[u(e)];
          block.patches.push_back({{d, high}, shared, int(p), std::nullopt});
        }
      }
    grid.blocks.push_back(std::move(block));
  }
  Mesh mesh = make_mesh(grid, comm);
  mesh.lattice = std::move(lattice);
  return mesh;
}

} // namespace granflux::cfd
