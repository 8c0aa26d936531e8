// SPDX-FileCopyrightText: 2026 The GranFlux developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <map>
#include <vector>

#include "grid_checks.hpp"

namespace granflux::cfd::testing {

using CellKey = std::array<long, 3>;

/// By the centre of each cell: its volume and the centres and volumes of its six neighbours, two
/// deep, in no order. None of it depends on blocks. All of the mesh is on one rank.
inline std::map<CellKey, std::vector<double>> geometry(const Mesh& mesh) {
  const auto key = [](const Vec3& x) {
    return CellKey{std::lround(x.x * 1e6), std::lround(x.y * 1e6), std::lround(x.z * 1e6)};
  };
  std::map<CellKey, std::vector<double>> cells;
  for_cells(mesh, [&](std::size_t b, std::ptrdiff_t c, const Index3& cell) {
    const Block& block = mesh.local[b];
    std::vector<double> about;
    for (std::size_t d = 0; d < 3; ++d)
      for (const int step : {-2, -1, 1, 2}) {
        Index3 there = cell;
        there[d] += step;
        if (std::abs(step) == 2 && !resolve(mesh, {block.id, there}))
          continue; // of two ghosts at a boundary only the nearer stands for something
        const std::ptrdiff_t at = c + step * block.layout.stride[d];
        const Vec3 x = vector_at(block.centre, at);
        about.push_back(x.x + 10 * x.y + 100 * x.z);
        about.push_back(block.volume[at]);
      }
    about.push_back(block.volume[c]);
    std::sort(about.begin(), about.end());
    EXPECT_TRUE(cells.emplace(key(vector_at(block.centre, c)), about).second);
  });
  return cells;
}

inline void expect_same_geometry(const Grid& a, const Grid& b, double tolerance = 1e-13) {
  const auto one = geometry(make_mesh(a, MPI_COMM_SELF)),
             two = geometry(make_mesh(b, MPI_COMM_SELF));
  ASSERT_EQ(one.size(), two.size());
  for (auto i = one.begin(), j = two.begin(); i != one.end(); ++i, ++j) {
    ASSERT_EQ(i->first, j->first);
    ASSERT_EQ(i->second.size(), j->second.size());
    for (std::size_t n = 0; n < i->second.size(); ++n)
      ASSERT_NEAR(i->second[n], j->second[n], tolerance);
  }
}

} // namespace granflux::cfd::testing
