// SPDX-FileCopyrightText: 2026 The GranFlux developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <vector>

#include <granflux/cfd/mesh.hpp>

namespace granflux::cfd::testing {

/// New direction d runs along old direction along[d], from its high end where turned[d].
struct Orientation {
  Index3 along{0, 1, 2};
  std::array<bool, 3> turned{};

  [[nodiscard]] bool right_handed() const {
    const bool even = (along[1] - along[0] + 3) % 3 == 1;
    return even == ((turned[0] + turned[1] + turned[2]) % 2 == 0);
  }
};

/// All 48.
inline std::vector<Orientation> orientations() {
  std::vector<Orientation> all;
  Index3 along{0, 1, 2};
  do {
    for (int bits = 0; bits < 8; ++bits)
      all.push_back({along, {(bits & 1) != 0, (bits & 2) != 0, (bits & 4) != 0}});
  } while (std::next_permutation(along.begin(), along.end()));
  return all;
}

/// The same grid with the indices of each block counted another way.
inline Grid reoriented(const Grid& grid, const std::vector<Orientation>& ways) {
  Grid out;
  out.boundaries = grid.boundaries;
  for (std::size_t b = 0; b < grid.blocks.size(); ++b) {
    const GridBlock& old = grid.blocks[b];
    const Orientation& way = ways[b];
    GridBlock block;
    block.name = old.name;
    for (std::size_t d = 0; d < 3; ++d)
      block.cells[d] = old.cells[std::size_t(way.along[d])];
    block.node = [old, way](int i, int j, int k) {
      const Index3 n{i, j, k};
      Index3 o{};
      for (std::size_t d = 0; d < 3; ++d) {
        const auto e = std::size_t(way.along[d]);
        o[e] = way.turned[d] ? old.cells[e] - n[d] : n[d];
      }
      return old.node(o[0], o[1], o[2]);
    };
    for (const Patch& patch : old.patches) {
      Patch p = patch;
      for (std::size_t d = 0; d < 3; ++d) {
        const auto e = std::size_t(way.along[d]);
        const int n = old.cells[e];
        p.cells.lo[d] = way.turned[d] ? n - patch.cells.hi[e] : patch.cells.lo[e];
        p.cells.hi[d] = way.turned[d] ? n - patch.cells.lo[e] : patch.cells.hi[e];
        if (patch.side.direction == int(e))
          p.side = {int(d), patch.side.high != way.turned[d]};
      }
      if (patch.link) {
        const Orientation& theirs = ways[std::size_t(patch.link->block)];
        const Index3 size = grid.blocks[std::size_t(patch.link->block)].cells;
        for (std::size_t a = 0; a < 3; ++a) {
          const auto old_a = std::size_t(theirs.along[a]);
          const auto e = std::size_t(patch.link->axis[old_a]);
          const auto d = std::size_t(std::find(way.along.begin(), way.along.end(), int(e)) -
                                     way.along.begin());
          int sign = patch.link->sign[old_a], offset = patch.link->offset[old_a];
          if (way.turned[d]) {
            offset += sign * (old.cells[e] - 1);
            sign = -sign;
          }
          if (theirs.turned[a]) {
            offset = size[old_a] - 1 - offset;
            sign = -sign;
          }
          p.link->axis[a] = int(d), p.link->sign[a] = sign, p.link->offset[a] = offset;
        }
      }
      block.patches.push_back(p);
    }
    out.blocks.push_back(std::move(block));
  }
  return out;
}

} // namespace granflux::cfd::testing
