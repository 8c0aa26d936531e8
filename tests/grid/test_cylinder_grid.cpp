// SPDX-FileCopyrightText: 2026 The GranFlux developers
// SPDX-License-Identifier: BSD-3-Clause
#include <granflux/cfd/cylinder_grid.hpp>

#include "expect_config_error.hpp"
#include "grid_checks.hpp"

using namespace granflux;
using namespace granflux::cfd;
using namespace granflux::cfd::testing;
using granflux::test::config_error;

namespace {

/// The drum of the paper: 300 cells a layer, 0.1524 m across.
CylinderGrid drum(int axis = 2) {
  CylinderGrid c;
  c.frame = {axis, {0.1, 0.2, -0.3}};
  c.radius = 0.0762, c.length = 0.01524;
  c.core = 10, c.radial = 5, c.axial = 3;
  return c;
}

/// Cross-section of the polygon along the wall.
double polygon_area(const CylinderGrid& c) {
  const int n = 4 * c.core;
  return 0.5 * n * std::sin(2 * pi / n) * c.radius * c.radius;
}

std::int64_t cells_of(const Grid& grid) {
  std::int64_t cells = 0;
  for (const GridBlock& block : grid.blocks)
    cells += std::int64_t(block.cells[0]) * block.cells[1] * block.cells[2];
  return cells;
}

} // namespace

TEST(CylinderGrid, HasTheBlocksAndCellsOfThePaper) {
  CylinderGrid c = drum();
  Grid grid = make_cylinder(c);
  EXPECT_EQ(grid.blocks.size(), 5u);
  EXPECT_EQ(cells_of(grid), 900);
  c.length = 0.0762, c.axial = 15, c.axial_blocks = 5;
  grid = make_cylinder(c);
  EXPECT_EQ(grid.blocks.size(), 25u);
  EXPECT_EQ(cells_of(grid), 4500);
  EXPECT_EQ(grid.boundaries, (std::vector<std::string>{"wall", "low", "high"}));
}

TEST(CylinderGrid, IsThePolygonalPrismAboutEveryAxis) {
  for (const int axis : {0, 1, 2})
    for (const int axial_blocks : {1, 2})
      for (const bool periodic : {false, true}) {
        CylinderGrid c = drum(axis);
        c.axial = 5, c.axial_blocks = axial_blocks, c.periodic_axis = periodic;
        const Grid grid = make_cylinder(c);
        EXPECT_EQ(expect_links_meet(grid),
                  axial_blocks * 16 + 10 * (axial_blocks - 1) + 10 * periodic);
        const Mesh mesh = make_mesh(grid, MPI_COMM_WORLD);
        EXPECT_NEAR(total_volume(mesh) / (polygon_area(c) * c.length), 1, 1e-13);
        EXPECT_LT(largest_gap(mesh), 1e-14);
        expect_ghosts_follow(mesh);
        const double edge = 2 * c.radius * std::sin(pi / (4 * c.core));
        EXPECT_NEAR(boundary_area(mesh, "wall"), 4 * c.core * edge * c.length, 1e-14);
        if (!periodic) {
          EXPECT_NEAR(boundary_area(mesh, "low") / polygon_area(c), 1, 1e-13);
          EXPECT_NEAR(boundary_area(mesh, "high") / polygon_area(c), 1, 1e-13);
        }
      }
}

TEST(CylinderGrid, OddAndLopsidedCountsFitToo) {
  for (const auto& [core, radial] : {std::pair{2, 1}, std::pair{7, 2}, std::pair{3, 9}}) {
    CylinderGrid c = drum();
    c.core = core, c.radial = radial, c.growth = 0.9;
    const Grid grid = make_cylinder(c);
    expect_links_meet(grid);
    const Mesh mesh = make_mesh(grid, MPI_COMM_WORLD);
    EXPECT_NEAR(total_volume(mesh) / (polygon_area(c) * c.length), 1, 1e-13);
  }
}

TEST(CylinderGrid, VolumesDifferLittle) {
  const Mesh mesh = make_mesh(make_cylinder(drum()), MPI_COMM_WORLD);
  double least = 1e300, most = 0;
  for_cells(mesh, [&](std::size_t b, std::ptrdiff_t c, const Index3&) {
    least = std::min(least, mesh.local[b].volume[c]);
    most = std::max(most, mesh.local[b].volume[c]);
  });
  EXPECT_NEAR(least / most, 0.449, 0.001);
}

TEST(CylinderGrid, RefusesWhatIsNoCylinder) {
  const auto refusal = [&](auto&& change) {
    CylinderGrid c = drum();
    change(c);
    return config_error([&] { (void)make_cylinder(c); });
  };
  EXPECT_EQ(refusal([](CylinderGrid& c) { c.radius = 0; }), "[grid] radius = 0: must be > 0 (m)");
  EXPECT_EQ(refusal([](CylinderGrid& c) { c.core = 1; }),
            "[grid] core = 1: must be at least 2 cells");
  EXPECT_EQ(
      refusal([](CylinderGrid& c) { c.axial_blocks = 2; }),
      "[grid] axial_blocks = 2 with axial = 3: at least 1 block, and at least 2 cells in each");
  EXPECT_EQ(refusal([](CylinderGrid& c) { c.core_radius = 1; }),
            "[grid] core_radius = 1: must be > 0 and < 1 (share of the radius)");
  EXPECT_EQ(refusal([](CylinderGrid& c) { c.bulge = 1; }),
            "[grid] bulge = 1: must be >= 0 and < 1 (1 would flatten the corners of the core)");
}
