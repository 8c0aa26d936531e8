// SPDX-FileCopyrightText: 2026 The GranFlux developers
// SPDX-License-Identifier: BSD-3-Clause

#include <gtest/gtest.h>
#include <limits>

#include <granflux/coupling/lattice_locate.hpp>

#include "sample_lattices.hpp"

using namespace granflux;
using namespace granflux::coupling;

namespace {

// Uniform, nearly uniform, and stretched both ways: what counts is the nodes, not the arithmetic.
std::vector<std::vector<double>> axes() {
  auto jittered = cfd::uniform_nodes(-1, 3, 30);
  for (std::size_t i = 1; i + 1 < jittered.size(); ++i)
    jittered[i] += (i % 2 ? 1e-4 : -1e-4);
  return {cfd::uniform_nodes(-0.3, 1, 10),     cfd::uniform_nodes(0.1, 0.7, 1),
          cfd::uniform_nodes(0, 1. / 3, 1000), jittered,
          stretched_nodes(1, 2, 17, 1.3),      stretched_nodes(0, 1.5, 9, 0.7)};
}

TEST(LatticeLocate, FaceBelongsToTheCellAbove) {
  for (const auto& nodes : axes())
    for (const bool periodic : {false, true}) {
      const LatticeAxis axis(nodes, periodic);
      for (int i = 0; i < axis.cells(); ++i) {
        const double low = nodes[std::size_t(i)], high = nodes[std::size_t(i) + 1];
        EXPECT_EQ(axis.cell(low), i);
        EXPECT_EQ(axis.cell(0.5 * (low + high)), i);
        EXPECT_EQ(axis.cell(std::nextafter(high, low)), i);
      }
    }
}

TEST(LatticeLocate, EndsOfTheDomain) {
  for (const auto& nodes : axes()) {
    const LatticeAxis axis(nodes, false);
    const double inf = std::numeric_limits<double>::infinity();
    EXPECT_EQ(axis.cell(nodes.back()), axis.cells() - 1);
    EXPECT_EQ(axis.cell(std::nextafter(nodes.back(), inf)), std::nullopt);
    EXPECT_EQ(axis.cell(std::nextafter(nodes.front(), -inf)), std::nullopt);
    EXPECT_EQ(axis.cell(inf), std::nullopt);
    EXPECT_EQ(axis.cell(std::numeric_limits<double>::quiet_NaN()), std::nullopt);
  }
}

TEST(LatticeLocate, PeriodicIndexGoesOn) {
  for (const auto& nodes : axes()) {
    const LatticeAxis axis(nodes, true);
    const int n = axis.cells();
    EXPECT_EQ(axis.cell(nodes.back()), n);
    for (int i = 0; i < n; ++i) {
      const double centre = axis.centre(i);
      for (const int period : {-2, -1, 1, 2}) {
        const double x = centre + period * axis.length();
        EXPECT_EQ(axis.cell(x), i + period * n);
        EXPECT_EQ(axis.wrap(i + period * n), i);
        EXPECT_NEAR(axis.centre(i + period * n), x, 1e-13);
      }
    }
    const double inf = std::numeric_limits<double>::infinity();
    EXPECT_EQ(axis.cell(inf), std::nullopt);
    EXPECT_EQ(axis.cell(-1e300), std::nullopt);
    EXPECT_EQ(axis.cell(std::numeric_limits<double>::quiet_NaN()), std::nullopt);
  }
}

TEST(LatticeLocate, FoldKeepsThePlaceInThePeriod) {
  const LatticeAxis axis(cfd::uniform_nodes(-0.3, 1, 10), true);
  EXPECT_EQ(axis.fold(0.65), 0.65);
  EXPECT_EQ(axis.fold(1.1), 1.1) << "within one period: left where it is";
  EXPECT_EQ(axis.fold(-1.2), -1.2);
  EXPECT_NEAR(axis.fold(0.65 + 17), 0.65, 1e-14);
  EXPECT_NEAR(axis.fold(0.65 - 5000), 0.65, 1e-12);
  const LatticeAxis walls(cfd::uniform_nodes(-0.3, 1, 10), false);
  EXPECT_EQ(walls.fold(17), 17);
}

TEST(LatticeLocate, AllDirectionsTogether) {
  const LatticeLocator lattice(sample_lattice({false, true, false}));
  EXPECT_EQ(lattice.cell({-0.3, 1, 0}), (cfd::Index3{0, 0, 0}));
  EXPECT_EQ(lattice.cell({0.7, 3, 1.5}), (cfd::Index3{9, 7, 4}));
  EXPECT_EQ(lattice.cell({0.71, 2, 1}), std::nullopt);
  EXPECT_EQ(lattice.wrap({3, -1, 2}), (cfd::Index3{3, 6, 2}));
}

} // namespace
