// SPDX-FileCopyrightText: 2026 The GranFlux developers
// SPDX-License-Identifier: BSD-3-Clause

// Iterations of the multigrid pressure solver from 32^3 to 128^3 cells.

#include <gtest/gtest.h>

#include "pressure_problem.hpp"

namespace granflux::cfd {
namespace {

using namespace testing;

int iterations(int n, const Vec3& spacing, const Medium& medium, bool open) {
  PressureProblem problem = pressure_problem({n, n, n}, spacing, {false, false, false}, {1, 1, 2});
  fill_system(problem, medium, open);
  BlockFields p = make_fields(problem.mesh);
  return make_multigrid_pressure_solver(problem.mesh, problem.singular, 1e-10)
      ->solve(problem.system, p)
      .iterations;
}

TEST(MultigridGrowth, AtMostThreeIterationsFrom32To128) {
  struct Case {
    const char* name;
    Vec3 spacing;
    Medium (*medium)(int n);
    bool open;
  };
  for (const Case& one :
       {Case{"closed", {1, 1, 1}, [](int) -> Medium { return uniform_medium; }, false},
        Case{"open", {1, 1, 1}, [](int) -> Medium { return uniform_medium; }, true},
        Case{"stretched", {20, 1, 1}, [](int) -> Medium { return uniform_medium; }, false},
        Case{"bed", {1, 1, 1}, [](int n) { return bed_medium(1e6, n); }, true},
        Case{"stretched bed", {1, 1, 20}, [](int n) { return bed_medium(1e6, n); }, true},
        Case{"clusters", {1, 1, 1}, [](int n) { return ball_medium(1e-6, n); }, false},
        Case{"bubbles", {1, 1, 1}, [](int n) { return ball_medium(1e6, n); }, true}}) {
    const int coarse = iterations(32, one.spacing, one.medium(32), one.open);
    const int fine = iterations(128, one.spacing, one.medium(128), one.open);
    EXPECT_LE(fine, coarse + 3) << one.name;
    EXPECT_LT(fine, 25) << one.name;
  }
}

} // namespace
} // namespace granflux::cfd
