// SPDX-FileCopyrightText: 2026 The GranFlux developers
// SPDX-License-Identifier: BSD-3-Clause

// Media whose coefficients jump by 1e6 from cell to cell, and regions that nearly touch: coarse
// cells are split there, and nowhere else.

#include <algorithm>

#include <gtest/gtest.h>
#include <omp.h>

#include <granflux/cfd/multigrid.hpp>

#include "pressure_problem.hpp"

namespace granflux::cfd {
namespace {

using namespace testing;

constexpr std::array<bool, 3> closed{false, false, false};
constexpr Vec3 cubes{1, 1, 1};

struct Solution {
  std::vector<double> p;
  int iterations;
};

Solution solve(PressureProblem& problem, double tolerance) {
  BlockFields p = make_fields(problem.mesh);
  const auto solver = make_multigrid_pressure_solver(problem.mesh, problem.singular, tolerance);
  const int iterations = solver->solve(problem.system, p).iterations;
  return {on_box(problem, p), iterations};
}

int iterations(int n, const Index3& blocks, const Medium& medium, bool open) {
  PressureProblem problem = pressure_problem({n, n, n}, cubes, closed, blocks);
  fill_system(problem, medium, open);
  return solve(problem, 1e-10).iterations;
}

std::vector<long> level_sizes(int n, const Medium& medium) {
  PressureProblem problem = pressure_problem({n, n, n}, cubes, closed, {1, 2, 2});
  fill_system(problem, medium, true);
  Multigrid multigrid(problem.mesh, problem.singular);
  multigrid.setup(problem.system);
  return multigrid.level_sizes();
}

TEST(MultigridJumps, TouchingBubblesTakeFewIterations) {
  for (const bool open : {false, true}) {
    EXPECT_LE(iterations(32, {1, 2, 2}, touching_medium(1e6, 32), open), 20) << open;
    EXPECT_LE(iterations(64, {1, 2, 2}, touching_medium(1e6, 64), open), 20) << open;
    EXPECT_LE(iterations(32, {1, 2, 2}, touching_medium(1e3, 32), open), 20) << open;
  }
}

TEST(MultigridJumps, WhiteNoiseTakesFewIterations) {
  for (const bool open : {false, true})
    for (const int n : {32, 64}) {
      EXPECT_LT(iterations(n, {1, 2, 2}, binary_medium(1e6), open), 25) << n << open;
      EXPECT_LT(iterations(n, {1, 2, 2}, random_medium(1e6), open), 25) << n << open;
    }
}

TEST(MultigridJumps, OnlyWhatIsBadlyCoupledIsSplit) {
  const int n = 32;
  const std::vector<long> joined{32768, 4096, 512, 64};
  for (const Medium& medium : {Medium(uniform_medium), bed_medium(1e6, n), ball_medium(1e6, n),
                               ball_medium(1e-6, n), random_medium(1e3)})
    EXPECT_EQ(level_sizes(n, medium), joined);
  // Two cubes of four cells that meet at a corner: in the middle of a coarse cell one more unknown.
  const auto meet_at = [](int corner) {
    return [corner](const Index3& c) {
      const auto in = [&](int lo) {
        return std::all_of(c.begin(), c.end(), [&](int i) { return i >= lo && i < lo + 4; });
      };
      return in(corner - 4) || in(corner) ? 1e6 : 1.0;
    };
  };
  EXPECT_EQ(level_sizes(n, meet_at(15)).at(1), 4097);
  // Between coarse cells they stay apart by themselves, until the corner lies inside one.
  EXPECT_EQ(level_sizes(n, meet_at(16)), joined);
  EXPECT_EQ(level_sizes(n, meet_at(14)).at(1), 4096);
  EXPECT_EQ(level_sizes(n, meet_at(14)).at(2), 513);
}

TEST(MultigridJumps, SameForAnyCutAndAnyNumberOfRanks) {
  const Index3 cells{24, 24, 24};
  for (const Medium& medium : {touching_medium(1e6, 24), binary_medium(1e6)}) {
    PressureProblem whole = pressure_problem(cells, cubes, closed, {1, 1, 1}, MPI_COMM_SELF);
    fill_system(whole, medium, true);
    const Solution one = solve(whole, 1e-8);
    // Cuts where cells of all levels begin: the same groups.
    for (const Index3& blocks : {Index3{3, 1, 3}, {1, 3, 3}, {3, 3, 3}}) {
      PressureProblem cut = pressure_problem(cells, cubes, closed, blocks);
      fill_system(cut, medium, true);
      const Solution other = solve(cut, 1e-8);
      EXPECT_EQ(other.iterations, one.iterations);
      EXPECT_LT(difference(other.p, one.p), 1e-10);
    }
    // Elsewhere the tolerance decides.
    PressureProblem cut = pressure_problem(cells, cubes, closed, {1, 7, 2});
    fill_system(cut, medium, true);
    const Solution other = solve(cut, 1e-14);
    EXPECT_LT(other.iterations, 40);
    EXPECT_LT(difference(other.p, solve(whole, 1e-14).p), 1e-14 * 1e6);
  }
}

TEST(MultigridJumps, TakesBlocksThatAreTurned) {
  const Medium medium = binary_medium(1e6);
  PressureProblem plain = pressure_problem({12, 12, 8}, cubes, {false, true, false}, {2, 2, 1});
  fill_system(plain, medium, true);
  PressureProblem turned = pressure_problem({12, 12, 8}, cubes, {false, true, false}, {2, 2, 1});
  turn_block(turned, 1, {1, 2, 0}, {0, 0, 0});
  turn_block(turned, 2, {1, 0, 2}, {1, 0, 0});
  turn_block(turned, 3, {0, 1, 2}, {1, 1, 0});
  fill_system(turned, medium, true);
  const Solution one = solve(plain, 1e-14), other = solve(turned, 1e-14);
  EXPECT_LT(difference(one.p, other.p), 1e-14 * 1e6);
  EXPECT_LE(std::abs(one.iterations - other.iterations), 3);
}

TEST(MultigridJumps, SameBitsForAnyNumberOfThreadsAndInEveryRun) {
  PressureProblem problem = pressure_problem({36, 32, 40}, cubes, closed, {1, 1, 4});
  fill_system(problem, binary_medium(1e6), true);
  const int threads = omp_get_max_threads();
  omp_set_num_threads(1);
  const std::vector<double> one = solve(problem, 1e-10).p;
  for (const int n : {2, 3}) {
    omp_set_num_threads(n);
    EXPECT_EQ(solve(problem, 1e-10).p, one) << n << " threads";
  }
  omp_set_num_threads(threads);
  // Whatever the solver was split for before.
  const auto used = make_multigrid_pressure_solver(problem.mesh, problem.singular, 1e-10);
  for (const Medium& medium :
       {touching_medium(1e6, 40), Medium(uniform_medium), binary_medium(1e6)}) {
    fill_system(problem, medium, true);
    BlockFields p = make_fields(problem.mesh);
    used->solve(problem.system, p);
    EXPECT_EQ(on_box(problem, p), solve(problem, 1e-10).p);
  }
}

} // namespace
} // namespace granflux::cfd
