// SPDX-FileCopyrightText: 2026 The GranFlux developers
// SPDX-License-Identifier: BSD-3-Clause
#include <granflux/cfd/annulus_grid.hpp>

#include "expect_config_error.hpp"
#include "grid_checks.hpp"

using namespace granflux;
using namespace granflux::cfd;
using namespace granflux::cfd::testing;
using granflux::test::config_error;

namespace {

AnnulusGrid gap(int axis = 2) {
  AnnulusGrid a;
  a.frame = {axis, {0.3, -0.2, 0.7}};
  a.inner_radius = 1, a.outer_radius = 2.5, a.length = 0.8;
  a.radial = 5, a.tangential = 14, a.axial = 3;
  return a;
}

/// Cross-section of a polygonal ring of n cells over an angle.
double ring_area(const AnnulusGrid& a) {
  const double step = a.sweep * pi / 180 / a.tangential;
  return 0.5 * a.tangential * std::sin(step) *
         (a.outer_radius * a.outer_radius - a.inner_radius * a.inner_radius);
}

} // namespace

TEST(AnnulusGrid, IsThePolygonalRingAboutEveryAxis) {
  for (const int axis : {0, 1, 2})
    for (const double sweep : {360., 90.})
      for (const bool periodic : {false, true}) {
        AnnulusGrid a = gap(axis);
        a.sweep = sweep, a.start_angle = 25, a.periodic_axis = periodic, a.growth = 1.2;
        const Grid grid = make_annulus(a);
        const int links = 2 * (sweep == 360) + 2 * periodic;
        EXPECT_EQ(expect_links_meet(grid), links);
        const Mesh mesh = make_mesh(grid, MPI_COMM_WORLD);
        EXPECT_NEAR(total_volume(mesh), ring_area(a) * a.length, 1e-13);
        EXPECT_LT(largest_gap(mesh), 1e-14);
        expect_ghosts_follow(mesh);
        const double chord = 2 * a.tangential * std::sin(sweep * pi / 360 / a.tangential);
        EXPECT_NEAR(boundary_area(mesh, "inner"), chord * a.inner_radius * a.length, 1e-13);
        EXPECT_NEAR(boundary_area(mesh, "outer"), chord * a.outer_radius * a.length, 1e-13);
        if (!periodic) {
          EXPECT_NEAR(boundary_area(mesh, "low"), ring_area(a), 1e-13);
          EXPECT_NEAR(boundary_area(mesh, "high"), ring_area(a), 1e-13);
        }
        if (sweep != 360) {
          EXPECT_NEAR(boundary_area(mesh, "start"), 1.5 * a.length, 1e-13);
          EXPECT_NEAR(boundary_area(mesh, "end"), 1.5 * a.length, 1e-13);
        }
      }
}

TEST(AnnulusGrid, StandsWhereItsFrameSays) {
  for (const int axis : {0, 1, 2}) {
    const AnnulusGrid a = gap(axis);
    const NodeMap node = make_annulus(a).blocks[0].node;
    const int p = (axis + 1) % 3, q = (axis + 2) % 3;
    const Vec3 start = node(0, 0, 0) - a.frame.origin;
    EXPECT_NEAR(start[p], 1, 1e-15);
    EXPECT_NEAR(start[q], 0, 1e-15);
    EXPECT_EQ(start[axis], 0);
    const Vec3 next = node(0, 1, 0) - a.frame.origin; // from p towards q
    EXPECT_GT(next[q], 0);
    EXPECT_NEAR(node(5, 0, 3)[axis] - a.frame.origin[axis], 0.8, 1e-15);
    EXPECT_NEAR(node(5, 0, 3)[p] - a.frame.origin[p], 2.5, 1e-15);
  }
}

TEST(AnnulusGrid, GrowthIsTheRatioOfWidths) {
  AnnulusGrid a = gap();
  a.growth = 1.3, a.radial = 12;
  const NodeMap node = make_annulus(a).blocks[0].node;
  const auto radius = [&](int i) { return node(i, 0, 0).x - a.frame.origin.x; };
  for (int i = 1; i < 12; ++i)
    EXPECT_NEAR((radius(i + 1) - radius(i)) / (radius(i) - radius(i - 1)), 1.3, 1e-12);
}

TEST(AnnulusGrid, TakesNodesOneByOne) {
  AnnulusGrid even = gap(), drawn = gap();
  even.tangential = drawn.tangential = 4, even.start_angle = 45;
  even.radial = drawn.radial = 3;
  drawn.radii = {1, 1.5, 2, 2.5};
  drawn.angles = {45, 135, 225, 315, 405};
  const NodeMap a = make_annulus(even).blocks[0].node, b = make_annulus(drawn).blocks[0].node;
  for (int i = 0; i <= 3; ++i)
    for (int j = 0; j <= 4; ++j)
      EXPECT_LT(norm(a(i, j, 1) - b(i, j, 1)), 1e-14) << i << ", " << j;

  drawn.radii = {1, 1.1, 1.3, 4};
  drawn.angles = {-170, -20, 10, 90, 190};
  EXPECT_EQ(config_error([&] { (void)make_annulus(drawn); }),
            "[grid] nodes_angle: -20 after -170: a cell must span less than 120 degrees");
  drawn.tangential = 8;
  drawn.angles = {-170, -130, -60, -20, 10, 50, 90, 140, 190};
  drawn.arcs = {{"inflow", 90, 300}, {"outflow", -60, 90}};
  const Grid grid = make_annulus(drawn);
  EXPECT_EQ(expect_links_meet(grid), 2);
  const Mesh mesh = make_mesh(grid, MPI_COMM_WORLD);
  EXPECT_LT(largest_gap(mesh), 1e-14);
  expect_ghosts_follow(mesh);
  const auto chord = [](double degrees) { return 2 * 4 * std::sin(degrees * pi / 360) * 0.8; };
  EXPECT_NEAR(boundary_area(mesh, "inflow"), chord(40) + chord(70) + 2 * chord(50), 1e-13);
  EXPECT_NEAR(boundary_area(mesh, "outflow"), 3 * chord(40) + chord(30), 1e-13);

  drawn.arcs.clear();
  drawn.tangential = 4;
  drawn.angles = {0, 20, 25, 60, 90};
  EXPECT_EQ(make_mesh(make_annulus(drawn), MPI_COMM_WORLD).boundaries,
            (std::vector<std::string>{"inner", "outer", "start", "end", "low", "high"}));
}

TEST(AnnulusGrid, ArcsDivideTheOuterCircle) {
  AnnulusGrid a = gap();
  a.tangential = 16;
  a.arcs = {{"inflow", 90, 270}, {"outflow", -90, 90}};
  const Grid grid = make_annulus(a);
  const Mesh mesh = make_mesh(grid, MPI_COMM_WORLD);
  EXPECT_EQ(mesh.boundaries,
            (std::vector<std::string>{"inner", "inflow", "outflow", "low", "high"}));
  const double half = 16 * 2.5 * std::sin(pi / 16) * 0.8;
  EXPECT_NEAR(boundary_area(mesh, "inflow"), half, 1e-13);
  EXPECT_NEAR(boundary_area(mesh, "outflow"), half, 1e-13);
  for (const Patch& patch : grid.blocks[0].patches)
    if (patch.boundary == 1) { // the half of negative p
      EXPECT_EQ(patch.cells.lo[1], 4);
      EXPECT_EQ(patch.cells.hi[1], 12);
    }

  const auto refusal = [&](std::vector<Arc> arcs) {
    a.arcs = std::move(arcs);
    return config_error([&] { (void)make_annulus(a); });
  };
  EXPECT_EQ(refusal({{"inflow", 90, 270}, {"outflow", -90, 102}}),
            "boundaries \"inflow\" and \"outflow\" overlap on the outer circle at 101.25 degrees: "
            "each face takes one boundary");
  EXPECT_EQ(refusal({{"inflow", 90, 270}, {"outflow", -60, 90}}),
            "the outer circle has no boundary at 281.25 degrees: its arcs must cover it");
  EXPECT_EQ(refusal({{"all", 0, 360}, {"none", 12, 20}}),
            "boundary \"none\": no face of the outer circle has its middle between 12 and 20 "
            "degrees");
  EXPECT_EQ(refusal({{"all", 0, 361}}),
            "boundary \"all\" angles = [0, 361]: must increase by at most 360 (degrees)");
}

TEST(AnnulusGrid, RefusesWhatIsNoAnnulus) {
  const auto refusal = [&](auto&& change) {
    AnnulusGrid a = gap();
    change(a);
    return config_error([&] { (void)make_annulus(a); });
  };
  EXPECT_EQ(refusal([](AnnulusGrid& a) { a.inner_radius = 0; }),
            "[grid] inner_radius = 0, outer_radius = 2.5: must be 0 < inner_radius < outer_radius "
            "(m); a full cylinder is kind = \"cylinder\"");
  EXPECT_EQ(refusal([](AnnulusGrid& a) { a.outer_radius = 1; }),
            "[grid] inner_radius = 1, outer_radius = 1: must be 0 < inner_radius < outer_radius "
            "(m); a full cylinder is kind = \"cylinder\"");
  EXPECT_EQ(refusal([](AnnulusGrid& a) { a.length = -1; }), "[grid] length = -1: must be > 0 (m)");
  EXPECT_EQ(refusal([](AnnulusGrid& a) { a.sweep = 361; }),
            "[grid] sweep = 361: must be > 0 and <= 360 (degrees)");
  EXPECT_EQ(refusal([](AnnulusGrid& a) { a.tangential = 3; }),
            "[grid] cells = [5, 3, 3]: too few around for 360 degrees: a cell must span less than "
            "120");
  EXPECT_EQ(refusal([](AnnulusGrid& a) { a.axial = 0; }),
            "[grid] cells = [5, 14, 0]: must be at least 1 each");
  EXPECT_EQ(refusal([](AnnulusGrid& a) { a.growth = 1e-9, a.radial = 20; }),
            "[grid] growth = 1e-09: with 20 cells the narrowest would have no width");
  EXPECT_EQ(refusal([](AnnulusGrid& a) {
              a.radii = {1, 2};
            }),
            "[grid] nodes_radius: 2 nodes for 5 cells: must be one more than cells");
  EXPECT_EQ(refusal([](AnnulusGrid& a) {
              a.radial = 2, a.radii = {1, 3, 2};
            }),
            "[grid] nodes_radius: 2 after 3: must increase from each to the next");
  EXPECT_EQ(refusal([](AnnulusGrid& a) {
              a.radial = 2, a.radii = {0, 1, 2};
            }),
            "[grid] nodes_radius: the first is 0: must be > 0 (m); a full cylinder is kind = "
            "\"cylinder\"");
  EXPECT_EQ(refusal([](AnnulusGrid& a) {
              a.tangential = 4, a.angles = {0, 90, 180, 270, 361};
            }),
            "[grid] nodes_angle: from 0 to 361: must span at most 360 (degrees)");
}
