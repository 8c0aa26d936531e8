// SPDX-FileCopyrightText: 2026 The GranFlux developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <granflux/cfd/join_blocks.hpp>
#include <granflux/cfd/mesh.hpp>

namespace granflux::cfd::testing {

/// A periodic square of side `length` made of 2 x 2 blocks of n x n x `deep` cells: the node that
/// all four share is moved off the middle, so grid lines bend where blocks meet, and every block
/// has its index directions turned against its neighbours' by a quarter.
inline Grid skewed_square(int n, double length, int deep = 1) {
  const double depth = length * deep / (2 * n);
  const auto moved = [length](double a, double b) { // corner (a, b), 0 <= a, b <= 2
    const bool middle = a == 1 && b == 1;
    return Vec3{length * (0.5 * a + (middle ? 0.06 : 0)), length * (0.5 * b + (middle ? 0.04 : 0)),
                0};
  };
  Grid grid;
  const auto turn = [](int block) { return block; }; // quarters
  for (int block = 0; block < 4; ++block) {
    const int x = block % 2, y = block / 2;
    GridBlock b;
    b.name = "quarter " + std::to_string(block);
    b.cells = {n, n, deep};
    b.node = [=](int i, int j, int k) {
      // Along x and y from the indices that are turned.
      const int along[4][2] = {{i, j}, {n - j, i}, {n - i, n - j}, {j, n - i}};
      const double s = double(along[turn(block)][0]) / n, t = double(along[turn(block)][1]) / n;
      Vec3 node = (1 - s) * (1 - t) * moved(x, y) + s * (1 - t) * moved(x + 1, y) +
                  (1 - s) * t * moved(x, y + 1) + s * t * moved(x + 1, y + 1);
      node.z = depth * k / deep;
      return node;
    };
    grid.blocks.push_back(std::move(b));
  }
  const auto local = [&](int towards, int block) { return (towards - turn(block) + 4) % 4; };
  constexpr int name_of[4] = {1, 2, -1, -2}; // direction of an index, as Transform counts
  for (int block = 0; block < 4; ++block) {
    const int x = block % 2, y = block / 2;
    for (const int towards : {0, 1}) { // x, y; the donor gets its half of the link here too
      const int donor = towards == 0 ? (1 - x) + 2 * y : x + 2 * (1 - y);
      const int side = local(towards, block);
      const Transform transform{name_of[local(turn(block), donor)],
                                name_of[local(turn(block) + 1, donor)], 3};
      Vec3 shift;
      if ((towards == 0 ? x : y) == 1)
        shift[towards] = length;
      join_sides(grid, block, {side % 2, side < 2}, donor, transform, shift);
    }
    join_sides(grid, block, {2, true}, block, {1, 2, 3}, {0, 0, depth});
  }
  return grid;
}

} // namespace granflux::cfd::testing
