// SPDX-FileCopyrightText: 2026 The GranFlux developers
// SPDX-License-Identifier: BSD-3-Clause

// Particles from a third to three times a cell, of sizes a thousandfold apart, two in a cell, and
// with their centres exactly on faces, edges and corners of cells and blocks: their volume is kept,
// the void fraction stays above 0, or the run stops and says where and what to do.

#include <cmath>
#include <gtest/gtest.h>
#include <numbers>
#include <optional>

#include <granflux/cfd/error.hpp>

#include "duct.hpp"

namespace {

using namespace granflux;
using namespace granflux::testing;

constexpr double cell = 1e-3;

/// What a step of upflow around particles held in place reports; the error where there is one.
struct Outcome {
  std::optional<coupling::ExchangeReport> report;
  std::string error;
  double fastest = 0; ///< gas [m/s]
};

Outcome flow_around(const std::vector<Particle>& particles, const char* kernel,
                    cfd::Index3 blocks = {0, 0, 0}) {
  constexpr cfd::Index3 n{8, 8, 8};
  cfd::GasCase c = upright_duct(n, {cell, cell, cell}, 0.1);
  box_grid(c).blocks = blocks;
  coupling::CouplingOptions options;
  options.void_fraction = kernel;
  coupling::Coupler coupler(c, options, MPI_COMM_WORLD);
  FakeHost host({0, 0, 0}, {n[0] * cell, n[1] * cell, n[2] * cell}, {true, true, false},
                MPI_COMM_WORLD);
  for (const Particle& q : particles)
    host.add(q);
  Outcome outcome;
  try {
    coupler.initialise(host.view(), 0);
    for (int step = 0; step < 5; ++step) {
      outcome.report = coupler.exchange(host.view(), 1e-4);
      coupler.apply(host.view(), 1e-4);
    }
  } catch (const NumericalError& error) {
    outcome.report.reset();
    outcome.error = error.what();
    return outcome;
  }
  outcome.fastest = largest(coupler.mesh(), [&](std::size_t b, std::ptrdiff_t p) {
    return std::abs(coupler.gas().velocity()[b][2][p]);
  });
  for (const coupling::FluidState& state : host.fluid)
    EXPECT_TRUE(std::isfinite(norm(state.force)));
  return outcome;
}

Particle ball(Vec3 x, double diameter, std::int64_t id = 1) {
  return sphere(id, x, {}, diameter / 2, 2500, true);
}

// Centre of a cell, and the middle of a face, an edge, a corner: 1, 2, 4, 8 cells are straddled.
const Vec3 places[] = {{4.5 * cell, 4.5 * cell, 4.5 * cell},
                       {4 * cell, 4.5 * cell, 4.5 * cell},
                       {4 * cell, 4 * cell, 4.5 * cell},
                       {4 * cell, 4 * cell, 4 * cell}};

TEST(LargeParticles, SmoothedKeepsVolumeAndGasFromAThirdToThreeTimesACell) {
  for (const double ratio : {0.3, 1., 2., 3.})
    for (const Vec3& x : places) {
      const Outcome outcome = flow_around({ball(x, ratio * cell)}, "smoothed");
      ASSERT_TRUE(outcome.report) << outcome.error;
      EXPECT_LT(outcome.report->volume_residual, 1e-12) << ratio;
      EXPECT_GT(outcome.report->void_fraction_min, 0.8) << ratio;
      EXPECT_LE(outcome.report->void_fraction_min, 1) << ratio;
      EXPECT_LT(outcome.report->momentum_residual, 1e-12) << ratio;
      EXPECT_LT(outcome.fastest, 0.2) << ratio; // 0.1 m/s go around it
    }
}

TEST(LargeParticles, OthersKeepTheVolumeOrNameTheCellAndTheCure) {
  int stopped = 0;
  for (const char* kernel : {"centre", "divided", "trilinear", "spline"})
    for (const double ratio : {0.3, 1., 2., 3.})
      for (const Vec3& x : places) {
        const Outcome outcome = flow_around({ball(x, ratio * cell)}, kernel);
        if (outcome.report) {
          EXPECT_LT(outcome.report->volume_residual, 1e-12) << kernel << ratio;
          EXPECT_GE(outcome.report->void_fraction_min, 0.05) << kernel << ratio;
          EXPECT_LT(outcome.fastest, 0.1 / 0.05) << kernel << ratio;
          EXPECT_LT(ratio, 2.5);
        } else {
          ++stopped;
          for (const char* word :
               {"in cell (", "void_fraction_floor", "smoothed", "smoothing_width", "coarser grid"})
            EXPECT_NE(outcome.error.find(word), std::string::npos) << outcome.error;
          EXPECT_GT(ratio, 1.5) << kernel << ": " << outcome.error;
        }
      }
  EXPECT_GT(stopped, 12); // among them: the whole of a ball of two cells given to one
}

TEST(LargeParticles, TwoCentresInOneCell) {
  const Vec3 x = places[0], y = x + Vec3{0, 0, 0.3 * cell};
  const std::vector<Particle> two{ball(x, cell, 1), ball(y, cell, 2)};
  const Outcome naive = flow_around(two, "centre"); // 1 - 2 pi / 6 is below 0
  ASSERT_FALSE(naive.report);
  EXPECT_NE(naive.error.find("void fraction -0.047"), std::string::npos) << naive.error;
  for (const char* kernel : {"trilinear", "spline", "smoothed"}) {
    const Outcome outcome = flow_around(two, kernel);
    ASSERT_TRUE(outcome.report) << kernel << ": " << outcome.error;
    EXPECT_LT(outcome.report->volume_residual, 1e-12);
    EXPECT_GT(outcome.report->void_fraction_min, 0.1);
  }
}

TEST(LargeParticles, AThousandfoldInSizeAndABillionInVolume) {
  std::vector<Particle> all{ball(places[3], 1.5 * cell)};
  for (int p = 0; p < 200; ++p)
    all.push_back(ball({(0.3 + p % 7) * cell, (0.6 + p % 5) * cell, (0.2 + p % 6) * cell},
                       1.5e-3 * cell, p + 2));
  for (const char* kernel : {"divided", "trilinear", "spline", "smoothed"}) {
    const Outcome outcome = flow_around(all, kernel);
    ASSERT_TRUE(outcome.report) << kernel << ": " << outcome.error;
    EXPECT_EQ(outcome.report->particles, 201);
    EXPECT_LT(outcome.report->volume_residual, 1e-12);
    EXPECT_LT(outcome.report->momentum_residual, 1e-12);
    EXPECT_LT(outcome.report->budget_residual, 1e-10);
    EXPECT_LT(outcome.fastest, 0.3);
  }
}

TEST(LargeParticles, OnCornersOfBlocksEachIsFoundOnce) {
  std::vector<Particle> all;
  for (int corner = 0; corner < 27; ++corner) // corners, edges, faces and middles of 8 blocks
    all.push_back(ball({corner % 3 * 4 * cell, corner / 3 % 3 * 4 * cell,
                        std::clamp(corner / 9 * 4 * cell, 0., 8 * cell)},
                       0.5 * cell, corner + 1));
  for (const char* kernel : {"centre", "divided", "trilinear", "spline", "smoothed"}) {
    const Outcome outcome = flow_around(all, kernel, {2, 2, 2});
    ASSERT_TRUE(outcome.report) << kernel << ": " << outcome.error;
    EXPECT_EQ(outcome.report->particles, 27) << kernel;
    EXPECT_EQ(outcome.report->outside, 0) << kernel;
    EXPECT_LT(outcome.report->volume_residual, 1e-12) << kernel;
  }
}

// Every node of a drum of five blocks: on its axis four cells meet, where the core ends three
// blocks do.
TEST(LargeParticles, OnEveryNodeOfADrumEachIsFoundOnce) {
  cfd::GasCase c;
  cfd::CylinderGrid grid;
  grid.radius = 0.05, grid.length = 0.03;
  grid.core = 4, grid.radial = 3, grid.axial = 4;
  c.grid = grid;
  for (const char* name : {"wall", "low", "high"})
    c.boundaries.push_back({.name = name, .kind = cfd::BoundaryKind::slip});
  for (const char* kernel : {"centre", "divided", "smoothed"}) {
    coupling::CouplingOptions options;
    options.void_fraction = kernel;
    coupling::Coupler coupler(c, options, MPI_COMM_SELF);
    FakeHost host({-0.05, -0.05, 0}, {0.05, 0.05, 0.03}, {}, MPI_COMM_SELF);
    std::int64_t id = 0;
    for (const cfd::Block& block : coupler.mesh().local) {
      const cfd::Layout& layout = block.layout;
      for (int k = 0; k <= layout.cells[2]; ++k)
        for (int j = 0; j <= layout.cells[1]; ++j)
          for (int i = 0; i <= layout.cells[0]; ++i) {
            const std::ptrdiff_t n = layout.at(i, j, k);
            const Vec3 x{block.node[0][n], block.node[1][n], block.node[2][n]};
            if (std::hypot(x.x, x.y) < 0.049) // the wall's facets round either way
              host.add(sphere(++id, x, {}, 1e-4, 2500, true));
          }
    }
    coupler.initialise(host.view(), 0);
    coupler.exchange(host.view(), 1e-4);
    EXPECT_GT(id, 400);
    EXPECT_EQ(coupler.report().particles, id) << kernel;
    EXPECT_EQ(coupler.report().outside, 0) << kernel;
    EXPECT_LT(coupler.report().volume_residual, 1e-12) << kernel;
  }
}

} // namespace
