// SPDX-FileCopyrightText: 2026 The GranFlux developers
// SPDX-License-Identifier: BSD-3-Clause
#include <random>

#include <granflux/cfd/annulus_grid.hpp>
#include <granflux/cfd/cylinder_grid.hpp>
#include <granflux/cfd/deal_blocks.hpp>
#include <granflux/cfd/split_blocks.hpp>

#include "expect_config_error.hpp"
#include "same_geometry.hpp"

using namespace granflux;
using namespace granflux::cfd;
using namespace granflux::cfd::testing;
using granflux::test::config_error;

namespace {

Grid drum(int core, int radial, int axial, bool periodic = true) {
  CylinderGrid c;
  c.radius = 1, c.length = 2;
  c.core = core, c.radial = radial, c.axial = axial, c.periodic_axis = periodic;
  return make_cylinder(c);
}

Grid gap(int radial, int tangential, int axial) {
  AnnulusGrid a;
  a.inner_radius = 1, a.outer_radius = 2, a.length = 1;
  a.radial = radial, a.tangential = tangential, a.axial = axial;
  a.arcs = {{"left", 90, 270}, {"right", -90, 90}};
  return make_annulus(a);
}

/// Cuts every block at random places, again and again, so that edges meet sides anywhere.
Pieces random_pieces(const Grid& grid, std::mt19937& random) {
  Pieces pieces;
  for (const GridBlock& block : grid.blocks) {
    std::vector<IndexBox> boxes{{{0, 0, 0}, block.cells}};
    for (int n = 0; n < 4; ++n) {
      IndexBox& box = boxes[random() % boxes.size()];
      const std::size_t d = random() % 3;
      const int length = box.hi[d] - box.lo[d];
      if (length < 2)
        continue;
      IndexBox upper = box;
      upper.lo[d] = box.hi[d] = box.lo[d] + 1 + int(random() % unsigned(length - 1));
      boxes.push_back(upper);
    }
    pieces.push_back(boxes);
  }
  return pieces;
}

std::int64_t cells_of(const Grid& grid) {
  std::int64_t cells = 0;
  for (const GridBlock& block : grid.blocks)
    cells += cell_count(block.cells);
  return cells;
}

double balance_of(const Grid& grid, int ranks) {
  std::vector<std::int64_t> cost;
  for (const GridBlock& block : grid.blocks)
    cost.push_back(cell_count(block.cells));
  return imbalance(cost, deal_blocks(cost, ranks), ranks);
}

} // namespace

TEST(DealBlocks, LargestLoadIsTheLeastPossible) {
  EXPECT_EQ(deal_blocks({5, 1, 1, 1, 1, 1}, 2), (std::vector<int>{0, 1, 1, 1, 1, 1}));
  EXPECT_EQ(deal_blocks({1, 1, 1, 9}, 3), (std::vector<int>{0, 0, 1, 2}));
  EXPECT_EQ(deal_blocks({3, 3, 3}, 3), (std::vector<int>{0, 1, 2}));
  EXPECT_EQ(config_error([] {
              (void)deal_blocks({3, 3}, 3);
            }),
            "grid: 2 blocks for 3 ranks: every rank needs at least one block");
  // Against every way to cut a row of blocks in three.
  std::mt19937 random(7);
  for (int n = 0; n < 50; ++n) {
    std::vector<std::int64_t> cost(8);
    for (auto& c : cost)
      c = 1 + random() % 20;
    std::int64_t least = 1 << 20;
    for (std::size_t i = 1; i < 7; ++i)
      for (std::size_t j = i + 1; j < 8; ++j) {
        std::array<std::int64_t, 3> load{};
        for (std::size_t b = 0; b < 8; ++b)
          load[b < i ? 0 : b < j ? 1 : 2] += cost[b];
        least = std::min(least, *std::max_element(load.begin(), load.end()));
      }
    std::array<std::int64_t, 3> load{};
    const auto rank_of = deal_blocks(cost, 3);
    for (std::size_t b = 0; b < 8; ++b)
      load[std::size_t(rank_of[b])] += cost[b];
    EXPECT_EQ(*std::max_element(load.begin(), load.end()), least);
  }
}

TEST(SplitBlocks, KeepsTheGeometryWhereverItIsCut) {
  std::mt19937 random(3);
  for (const Grid& whole : {drum(6, 4, 5), drum(5, 3, 4, false), gap(4, 9, 3)})
    for (int n = 0; n < 8; ++n) {
      const Grid split = split_blocks(whole, random_pieces(whole, random));
      EXPECT_GT(split.blocks.size(), whole.blocks.size());
      expect_links_meet(split);
      expect_same_geometry(whole, split);
    }
}

TEST(SplitBlocks, BoundariesAreCutAlong) {
  std::mt19937 random(11);
  const Grid whole = gap(4, 12, 3);
  const Mesh mesh = make_mesh(split_blocks(whole, random_pieces(whole, random)), MPI_COMM_SELF);
  const Mesh one = make_mesh(whole, MPI_COMM_SELF);
  EXPECT_EQ(mesh.boundaries, one.boundaries);
  for (const std::string& name : one.boundaries)
    EXPECT_NEAR(boundary_area(mesh, name), boundary_area(one, name), 1e-13);
}

TEST(SplitForRanks, BalancesAnyNumberOfRanks) {
  for (const Grid& grid :
       {drum(10, 5, 3), drum(10, 5, 15), drum(16, 8, 32), gap(16, 48, 8), gap(64, 128, 1)})
    for (int ranks = 1; ranks <= 13; ++ranks) {
      const Grid split = split_for_ranks(grid, ranks);
      // With fewer cells, a plane of them is more than that.
      const double limit = cells_of(grid) / ranks >= 300 ? 1.1 : 1.35;
      EXPECT_LE(balance_of(split, ranks), limit)
          << grid.blocks.size() << " blocks for " << ranks << " ranks";
      EXPECT_LE(split.blocks.size(), grid.blocks.size() + std::size_t(ranks));
      expect_links_meet(split);
    }
}

TEST(SplitForRanks, LeavesWhatIsBalancedAlone) {
  const Grid grid = drum(10, 10, 8);
  for (const int ranks : {1, 5})
    EXPECT_EQ(split_for_ranks(grid, ranks).blocks.size(), 5u);
}

TEST(SplitForRanks, CutsWhereMultigridCanGoOn) {
  for (const int ranks : {2, 4, 8}) {
    const Grid split = split_for_ranks(gap(32, 64, 16), ranks);
    EXPECT_EQ(balance_of(split, ranks), 1);
    for (const GridBlock& block : split.blocks)
      for (const int n : block.cells)
        EXPECT_EQ(n % 8, 0);
  }
}

TEST(SplitForRanks, TooFewCellsAreAnError) {
  const auto message = config_error([] { (void)split_for_ranks(gap(1, 4, 1), 4); });
  EXPECT_EQ(message,
            "grid: 1 blocks cannot be cut into pieces for 4 ranks with at least two cells along "
            "each direction that is cut: use fewer ranks or more cells");
}

TEST(SplitForRanks, TheRunsMeshIsTheSame) {
  int ranks = 1;
  MPI_Comm_size(MPI_COMM_WORLD, &ranks);
  const Grid whole = drum(7, 4, 6);
  const Mesh mesh = make_mesh(split_for_ranks(whole, ranks), MPI_COMM_WORLD);
  EXPECT_LE(imbalance(mesh), 1.1);
  EXPECT_NEAR(total_volume(mesh), total_volume(make_mesh(whole, MPI_COMM_SELF)), 1e-12);
  EXPECT_LT(largest_gap(mesh), 1e-14);
  expect_ghosts_follow(mesh);
}
