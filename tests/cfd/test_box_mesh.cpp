// SPDX-FileCopyrightText: 2026 The GranFlux developers
// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <granflux/cfd/error.hpp>
#include <granflux/cfd/halo.hpp>

#include "box_case.hpp"

using namespace granflux;
using namespace granflux::cfd;
using namespace granflux::cfd::testing;

namespace {

std::string refusal(const BoxGrid& grid) {
  try {
    make_box_mesh(grid, MPI_COMM_WORLD);
  } catch (const ConfigError& e) {
    return e.what();
  }
  return "accepted";
}

TEST(BoxMesh, VolumesAndAreasOfAStretchedBox) {
  GasCase c = box_case({4, 6, 8}, {1, 1, 1}, {false, true, false});
  box_grid(c).nodes[0] = {0, 0.1, 0.3, 0.6, 1.0};
  const Mesh mesh = make_mesh(c, MPI_COMM_WORLD);
  double volume = 0;
  for_each_cell(mesh, [&](std::size_t b, std::ptrdiff_t p, const Vec3&) {
    const Block& block = mesh.local[b];
    volume += block.volume[p];
    Vec3 closed; // a closed surface has no net area
    for (std::size_t d = 0; d < 3; ++d)
      for (std::size_t m = 0; m < 3; ++m)
        closed[int(m)] += block.area[d][m][p + block.layout.stride[d]] - block.area[d][m][p];
    EXPECT_NEAR(norm(closed), 0, 1e-16);
    const double width = block.node[0][p + 1] - block.node[0][p];
    EXPECT_NEAR(block.volume[p], width / 48, 1e-15);
  });
  MPI_Allreduce(MPI_IN_PLACE, &volume, 1, MPI_DOUBLE, MPI_SUM, MPI_COMM_WORLD);
  EXPECT_NEAR(volume, 1, 1e-14);
}

TEST(BoxMesh, HaloContinuesAFieldThroughBlocksAndPeriods) {
  for (const Index3 blocks : {Index3{0, 0, 0}, Index3{2, 1, 4}}) {
    const GasCase c = box_case({8, 1, 12}, {1, 1, 1}, {true, true, false}, blocks);
    const Mesh mesh = make_mesh(c, MPI_COMM_WORLD);
    const Halo halo(mesh);
    BlockFields f = make_fields(mesh, -1);
    const auto value = [](const Vec3& x) { return std::sin(2 * pi * x.x) + 7 * x.z; };
    for_each_cell(mesh,
                  [&](std::size_t b, std::ptrdiff_t p, const Vec3& x) { f[b][p] = value(x); });
    halo.exchange({&f});
    for (std::size_t b = 0; b < mesh.local.size(); ++b) {
      const Block& block = mesh.local[b];
      const Index3 n = block.layout.cells;
      const auto check = [&](int i, int j, int k) {
        const std::ptrdiff_t p = block.layout.at(i, j, k);
        const Vec3 x{block.centre[0][p], block.centre[1][p], block.centre[2][p]};
        if (x.z > 0 && x.z < 1) {
          EXPECT_NEAR(f[b][p], value(x), 1e-13);
        }
      };
      for (const int layer : {1, 2}) {
        check(-layer, 0, 0), check(n[0] - 1 + layer, 0, n[2] - 1);
        check(0, -layer, 0), check(n[0] - 1, n[1] - 1 + layer, 0);
        check(0, 0, -layer), check(n[0] - 1, 0, n[2] - 1 + layer);
      }
    }
  }
}

TEST(BoxMesh, RefusesBadPatches) {
  const GasCase good = box_case({4, 4, 8}, {1, 1, 1}, {false, true, false});
  EXPECT_EQ(refusal(box_grid(good)), "accepted");
  BoxGrid grid = box_grid(good);
  grid.patches.push_back({"jet", {2, false}, {0.2, 0, 0}, {0.6, 1, 0}});
  EXPECT_NE(refusal(grid).find("\"z_low\" and \"jet\" overlap on 4 faces"), std::string::npos)
      << refusal(grid);
  grid = box_grid(good);
  grid.patches.pop_back();
  EXPECT_NE(refusal(grid).find("side z_high: 16 faces have no boundary"), std::string::npos);
  grid = box_grid(good);
  grid.patches.push_back({"lid", {1, true}, {}, {}});
  EXPECT_NE(refusal(grid).find("\"lid\": its side y_high is periodic"), std::string::npos);
  grid = box_grid(good);
  grid.nodes[0][2] = grid.nodes[0][1];
  EXPECT_NE(refusal(grid).find("increase strictly"), std::string::npos);
  grid = box_grid(good);
  grid.blocks = {3, 1, 2};
  EXPECT_NE(refusal(grid).find("3 along x with 4 cells"), std::string::npos);
}

TEST(BoxMesh, FoldedCellIsNamed) {
  Grid grid;
  grid.boundaries = {"all"};
  GridBlock block{"bent",
                  {2, 2, 2},
                  [](int i, int j, int k) {
                    return Vec3{i == 1 ? 2.5 : double(i), double(j), double(k)};
                  },
                  {}};
  for (int d = 0; d < 3; ++d)
    for (const bool high : {false, true}) {
      IndexBox side{{0, 0, 0}, {2, 2, 2}};
      (high ? side.lo : side.hi)[std::size_t(d)] = 1;
      block.patches.push_back({{d, high}, side, 0, std::nullopt});
    }
  grid.blocks.push_back(block);
  try {
    make_mesh(grid, MPI_COMM_SELF);
    FAIL() << "not refused";
  } catch (const ConfigError& error) {
    EXPECT_NE(std::string(error.what()).find("cell (1, 0, 0) of block 0 (bent)"), std::string::npos)
        << error.what();
  }
}

} // namespace
