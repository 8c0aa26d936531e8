// SPDX-FileCopyrightText: 2026 The GranFlux developers
// SPDX-License-Identifier: BSD-3-Clause
#include <cmath>
#include <limits>
#include <random>

#include <gtest/gtest.h>

#include <granflux/cfd/annulus_grid.hpp>
#include <granflux/cfd/cylinder_grid.hpp>
#include <granflux/cfd/mesh.hpp>
#include <granflux/cfd/split_blocks.hpp>
#include <granflux/coupling/block_locate.hpp>

namespace granflux::coupling {
namespace {

using cfd::Index3;

cfd::Grid drum(bool periodic) {
  cfd::CylinderGrid cylinder;
  cylinder.radius = 0.5, cylinder.length = 0.8;
  cylinder.core = 4, cylinder.radial = 3, cylinder.axial = 6;
  cylinder.axial_blocks = 2;
  cylinder.periodic_axis = periodic;
  return make_cylinder(cylinder);
}

cfd::Grid ring() {
  cfd::AnnulusGrid annulus;
  annulus.inner_radius = 0.3, annulus.outer_radius = 1, annulus.length = 0.4;
  annulus.radial = 7, annulus.tangential = 20, annulus.axial = 3;
  return split_for_ranks(make_annulus(annulus), 2);
}

/// The point at `share` of the way through a cell, by the trilinear map of its nodes.
Vec3 point_in(const cfd::GridBlock& block, const Index3& c, const Vec3& share) {
  Vec3 x;
  for (int n = 0; n < 8; ++n) {
    const int i = n & 1, j = n >> 1 & 1, k = n >> 2;
    const double weight =
        (i ? share.x : 1 - share.x) * (j ? share.y : 1 - share.y) * (k ? share.z : 1 - share.z);
    x += weight * block.node(c[0] + i, c[1] + j, c[2] + k);
  }
  return x;
}

/// body(block, cell)
template <class Body> void for_each_cell(const cfd::Grid& grid, Body&& body) {
  for (int b = 0; b < int(grid.blocks.size()); ++b) {
    const auto [ni, nj, nk] = grid.blocks[std::size_t(b)].cells;
    for (int k = 0; k < nk; ++k)
      for (int j = 0; j < nj; ++j)
        for (int i = 0; i < ni; ++i)
          body(b, Index3{i, j, k});
  }
}

void expect_points_found(const cfd::Grid& grid) {
  const cfd::Mesh mesh = make_mesh(grid, MPI_COMM_WORLD);
  const BlockLocator locator(mesh);
  const BlockStack stack(mesh.blocks);
  std::mt19937 random(1);
  std::uniform_real_distribution<double> inside(1e-6, 1 - 1e-6);
  for_each_cell(grid, [&](int b, const Index3& c) {
    for (int n = 0; n < 5; ++n) {
      const Vec3 x = point_in(grid.blocks[std::size_t(b)], c,
                              {inside(random), inside(random), inside(random)});
      const auto found = locator.cell(locator.fold(x));
      ASSERT_TRUE(found) << "block " << b << ", (" << x.x << ", " << x.y << ", " << x.z << ")";
      EXPECT_EQ(*found, (Index3{c[0], c[1], c[2] + stack.first(b)}));
    }
  });
}

TEST(BlockLocate, FindsTheCellOfAnyPointInside) {
  expect_points_found(drum(false));
  expect_points_found(drum(true));
  expect_points_found(ring());
}

/// A drum whose rows of cells wind about the axis: faces that are not flat.
cfd::Grid twisted_drum() {
  cfd::Grid grid = drum(false);
  for (cfd::GridBlock& block : grid.blocks)
    block.node = [straight = block.node](int i, int j, int k) {
      const Vec3 x = straight(i, j, k);
      const double angle = 0.8 * x.z;
      return Vec3{std::cos(angle) * x.x - std::sin(angle) * x.y,
                  std::sin(angle) * x.x + std::cos(angle) * x.y, x.z};
    };
  return grid;
}

TEST(BlockLocate, FacesThatAreNotFlat) {
  expect_points_found(twisted_drum());
}

// The quick ways must not differ from the thorough one, points on and near faces included.
TEST(BlockLocate, LookingNearbyChangesNothing) {
  for (const cfd::Grid& grid : {drum(true), ring(), twisted_drum()}) {
    const cfd::Mesh mesh = make_mesh(grid, MPI_COMM_WORLD);
    const BlockLocator locator(mesh);
    const BlockStack stack(mesh.blocks);
    int within = 0;
    for_each_cell(grid, [&](int b, const Index3& c) {
      const Index3 here{c[0], c[1], c[2] + stack.first(b)};
      const auto at = [&](double i, double j, double k) {
        return point_in(grid.blocks[std::size_t(b)], c, {i, j, k});
      };
      for (const double i : {-0.3, -1e-7, 0., 1e-7, 0.4, 1., 1 + 1e-12, 1.2})
        for (const double k : {0., 0.5, 1 - 1e-6, 1.1}) {
          const Vec3 x = at(i, 0.9, k);
          EXPECT_EQ(locator.cell(x, here), locator.cell(x));
        }
      const Vec3 middle = at(0.5, 0.5, 0.5);
      const double to_face = norm(middle - at(0.5, 0.5, 0));
      EXPECT_LT(locator.room(here, middle), 1.001 * to_face);
      if (locator.room(here, middle) > 0.2 * to_face) {
        ++within;
        for (const Vec3& way : {Vec3{1, 0, 0}, Vec3{0, -1, 0}, Vec3{0.6, 0.8, 0}})
          EXPECT_EQ(locator.cell(middle + 0.2 * to_face * way), here);
      }
    });
    EXPECT_GT(within, 100);
  }
}

TEST(BlockLocate, NodesAndFacesBelongToOneCell) {
  const cfd::Grid grid = drum(true);
  const cfd::Mesh mesh = make_mesh(grid, MPI_COMM_WORLD);
  const BlockLocator locator(mesh);
  for_each_cell(grid, [&](int b, const Index3& c) {
    for (const Vec3& share : {Vec3{0, 0, 0}, Vec3{1, 1, 1}, Vec3{0.5, 1, 0.3}, Vec3{1, 0.2, 0.7}})
      EXPECT_TRUE(locator.cell(locator.fold(point_in(grid.blocks[std::size_t(b)], c, share))));
  });
}

TEST(BlockLocate, NothingOutside) {
  const cfd::Mesh mesh = make_mesh(drum(false), MPI_COMM_WORLD);
  const BlockLocator locator(mesh);
  EXPECT_FALSE(locator.cell({0.4, 0.4, 0.1})); // in the box around, not in the drum
  EXPECT_FALSE(locator.cell({0, 0, -1e-6}));
  EXPECT_FALSE(locator.cell({0, 0, 0.8 + 1e-6}));
  EXPECT_FALSE(locator.cell({std::numeric_limits<double>::quiet_NaN(), 0, 0.1}));
  EXPECT_TRUE(locator.cell({0, 0, 0.8}));
  const BlockLocator of_ring(make_mesh(ring(), MPI_COMM_WORLD));
  EXPECT_FALSE(of_ring.cell({0.1, 0.1, 0.2})); // in the hole
}

TEST(BlockLocate, PeriodsAreFolded) {
  const cfd::Mesh mesh = make_mesh(drum(true), MPI_COMM_WORLD);
  const BlockLocator locator(mesh);
  EXPECT_EQ(locator.extent().periodic, (std::array{false, false, true}));
  for (const double periods : {-3., -1., 0., 1., 7.}) {
    const Vec3 image = locator.fold({0.1, -0.2, 0.3 + 0.8 * periods});
    EXPECT_NEAR(image.z, 0.3, 1e-14);
    EXPECT_EQ(image.x, 0.1);
    EXPECT_EQ(locator.cell(image), locator.cell({0.1, -0.2, 0.3}));
  }
}

} // namespace
} // namespace granflux::coupling
