// SPDX-FileCopyrightText: 2026 The GranFlux developers
// SPDX-License-Identifier: BSD-3-Clause
#include <granflux/cfd/box_mesh.hpp>
#include <granflux/cfd/cylinder_grid.hpp>
#include <granflux/cfd/mesh_quality.hpp>
#include <granflux/cfd/split_blocks.hpp>

#include "expect_config_error.hpp"
#include "grid_checks.hpp"

using namespace granflux;
using namespace granflux::cfd;
using namespace granflux::cfd::testing;
using granflux::test::config_error;

namespace {

/// Boxes of cells leaning by an angle along x; 1, 2, 4 times as high as the first along z.
Grid leaning(double degrees) {
  Grid grid;
  grid.boundaries = {"all"};
  GridBlock block;
  block.cells = {4, 4, 3};
  const double slope = std::tan(degrees * pi / 180);
  block.node = [slope](int i, int j, int k) {
    const double z = (1 << k) - 1;
    return Vec3{0.5 * i + slope * z, double(j), z};
  };
  for (int d = 0; d < 3; ++d)
    for (const bool high : {false, true})
      block.patches.push_back(boundary_side(block.cells, {d, high}, 0));
  grid.blocks.push_back(block);
  return grid;
}

Mesh mesh_of(const Grid& grid) {
  int ranks = 1;
  MPI_Comm_size(MPI_COMM_WORLD, &ranks);
  return make_mesh(split_for_ranks(grid, ranks), MPI_COMM_WORLD);
}

} // namespace

TEST(MeshQuality, OfLeaningCellsIsTheirClosedForm) {
  for (const double angle : {0., 30., 60.}) {
    const MeshQuality q = measure_quality(mesh_of(leaning(angle)));
    EXPECT_EQ(q.cells, 48);
    EXPECT_NEAR(q.least_volume.value, 0.5, 1e-14);
    EXPECT_NEAR(q.largest_volume.value, 2, 1e-14);
    EXPECT_NEAR(q.volume_jump.value, 2, 1e-14);
    EXPECT_NEAR(q.non_orthogonality.value, angle, 1e-12);
    EXPECT_NEAR(q.skewness.value, 0, 1e-14); // lines lean as the cells do
    // Widths: along z 4; between the leaning sides 0.5 cos(angle).
    EXPECT_NEAR(q.aspect_ratio.value, 4 / (0.5 * std::cos(angle * pi / 180)), 1e-12);
  }
}

TEST(MeshQuality, SaysWhereItIs) {
  const MeshQuality q = measure_quality(make_mesh(leaning(0), MPI_COMM_SELF));
  EXPECT_EQ(q.least_volume.cell, (Index3{0, 0, 0}));
  EXPECT_EQ(q.largest_volume.cell, (Index3{0, 0, 2}));
  EXPECT_EQ(q.aspect_ratio.cell, (Index3{0, 0, 2}));
  EXPECT_EQ(q.volume_jump.cell, (Index3{0, 0, 1}));
  const std::string text = describe(q);
  EXPECT_NE(text.find("48 cells of 0.5 m3 (block 0 cell (0, 0, 0))"), std::string::npos) << text;
  EXPECT_NE(text.find("to 2 m3 (block 0 cell (0, 0, 2))"), std::string::npos) << text;
}

TEST(MeshQuality, SkewnessIsTheFacesOffset) {
  // Two columns of cells, the right one's centres raised by 0.25 by its far side.
  Grid grid = leaning(0);
  GridBlock& block = grid.blocks.front();
  block.cells = {2, 1, 1};
  block.node = [](int i, int j, int k) {
    return Vec3{double(i), double(j), k + (i == 2 ? 0.5 : 0)};
  };
  block.patches.clear();
  for (int d = 0; d < 3; ++d)
    for (const bool high : {false, true})
      block.patches.push_back(boundary_side(block.cells, {d, high}, 0));
  const MeshQuality q = measure_quality(make_mesh(grid, MPI_COMM_SELF));
  EXPECT_NEAR(q.skewness.value, 0.125 / std::hypot(1, 0.25), 1e-14);
  EXPECT_EQ(q.skewness.cell, (Index3{1, 0, 0}));
}

TEST(MeshQuality, OfTheDrumIsThatOfItsManual) {
  // Computed by an independent program for the same cross-section: 19.902 degrees, 0.262, 1.186.
  CylinderGrid c;
  c.radius = 0.0762, c.length = 0.01524;
  c.core = 10, c.radial = 5, c.axial = 3, c.periodic_axis = true;
  const MeshQuality q = measure_quality(mesh_of(make_cylinder(c)));
  EXPECT_NEAR(q.least_volume.value / q.largest_volume.value, 0.449, 5e-4);
  EXPECT_NEAR(q.non_orthogonality.value, 19.902, 5e-4);
  EXPECT_NEAR(q.skewness.value, 0.262, 5e-4);
  EXPECT_NEAR(q.volume_jump.value, 1.186, 5e-4);
}

TEST(MeshQuality, WarnsThenRefuses) {
  const auto warning = [](double angle) {
    return quality_warning(measure_quality(mesh_of(leaning(angle))));
  };
  EXPECT_EQ(warning(69), "");
  EXPECT_NE(warning(71).find("71.0 degrees at block"), std::string::npos) << warning(71);
  EXPECT_NE(config_error([&] { (void)warning(86); }).find("86.0 degrees"), std::string::npos);
}
