// SPDX-FileCopyrightText: 2026 The GranFlux developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cmath>
#include <string>

#include <granflux/cfd/join_blocks.hpp>
#include <granflux/cfd/split_blocks.hpp>

namespace granflux::cfd::testing {

/// A unit cube of 6 x 5 x 4 bent cells in eight blocks; periodic along z if asked for. Nodes on z =
/// 1 are those on z = 0 moved by exactly 1.
inline Grid bent_cube(bool periodic = false) {
  Grid whole;
  GridBlock block;
  block.name = "cube";
  block.cells = {6, 5, 4};
  block.node = [](int i, int j, int k) {
    const double x = i / 6., y = j / 5., z = k / 4.;
    const double bend = 0.5 * x * (1 - x) * y * (1 - y);
    return Vec3{x + 0.3 * bend + 0.1 * z, y - 0.4 * bend, z + 0.25 * bend};
  };
  whole.blocks.push_back(block);
  for (int d = 0; d < 3; ++d) {
    if (d == 2 && periodic) {
      join_sides(whole, 0, {2, true}, 0, {1, 2, 3}, {0.1, 0, 1});
      continue;
    }
    for (const bool high : {false, true}) {
      whole.blocks[0].patches.push_back(
          boundary_side(block.cells, {d, high}, int(whole.boundaries.size())));
      whole.boundaries.push_back(std::string(1, "xyz"[d]) + (high ? " high" : " low"));
    }
  }
  Pieces pieces(1);
  for (int k = 0; k < 2; ++k)
    for (int j = 0; j < 2; ++j)
      for (int i = 0; i < 2; ++i)
        pieces[0].push_back({{i ? 4 : 0, j ? 2 : 0, k ? 3 : 0}, {i ? 6 : 4, j ? 5 : 2, k ? 4 : 3}});
  return split_blocks(whole, pieces);
}

} // namespace granflux::cfd::testing
