// SPDX-FileCopyrightText: 2026 The GranFlux developers
// SPDX-License-Identifier: BSD-3-Clause
#include <random>

#include "bent_cube.hpp"
#include "expect_config_error.hpp"
#include "reoriented.hpp"
#include "same_geometry.hpp"

using namespace granflux;
using namespace granflux::cfd;
using namespace granflux::cfd::testing;

TEST(Orientations, HalfOfAllAreRightHanded) {
  const auto all = orientations();
  EXPECT_EQ(all.size(), 48u);
  EXPECT_EQ(std::count_if(all.begin(), all.end(), [](auto& o) { return o.right_handed(); }), 24);
}

// A block in each of the 24 ways beside seven that stay, then all in random ways.
TEST(Orientations, DoNotChangeTheMesh) {
  std::mt19937 random(5);
  std::vector<Orientation> right;
  for (const Orientation& way : orientations())
    if (way.right_handed())
      right.push_back(way);
  for (const bool periodic : {false, true}) {
    const Grid cube = bent_cube(periodic);
    expect_links_meet(cube);
    for (const Orientation& way : right)
      for (const std::size_t block : {0u, 5u}) {
        std::vector<Orientation> ways(8);
        ways[block] = way;
        const Grid turned = reoriented(cube, ways);
        expect_links_meet(turned);
        expect_same_geometry(cube, turned);
      }
    for (int n = 0; n < 20; ++n) {
      std::vector<Orientation> ways(8);
      for (Orientation& way : ways)
        way = right[random() % right.size()];
      const Grid turned = reoriented(cube, ways);
      expect_links_meet(turned);
      expect_same_geometry(cube, turned);
    }
  }
}

TEST(Orientations, ALeftHandedBlockIsRefused) {
  std::vector<Orientation> ways(8);
  ways[3].turned[0] = true;
  const Grid turned = reoriented(bent_cube(), ways);
  const auto message =
      granflux::test::config_error([&] { (void)make_mesh(turned, MPI_COMM_SELF); });
  EXPECT_NE(message.find("block 3"), std::string::npos) << message;
}
