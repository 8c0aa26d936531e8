// SPDX-FileCopyrightText: 2026 The GranFlux developers
// SPDX-License-Identifier: BSD-3-Clause

// hypre as pressure solver: the same solutions as the multigrid solver's.

#include <gtest/gtest.h>

#include <granflux/cfd/error.hpp>

#include "pressure_problem.hpp"

namespace granflux::cfd {
namespace {

using namespace testing;

std::vector<double> solution(PressureSolver& solver, PressureProblem& problem) {
  BlockFields p = make_fields(problem.mesh);
  const PressureReport report = solver.solve(problem.system, p);
  EXPECT_GT(report.iterations, 0);
  EXPECT_LT(report.iterations, 25);
  EXPECT_LE(report.residual, 1e-12);
  return on_box(problem, p);
}

TEST(HyprePressureSolver, AgreesWithMultigrid) {
  for (const bool open : {false, true}) {
    PressureProblem problem =
        pressure_problem({14, 10, 13}, {1, 1.5, 0.8}, {true, false, false}, {2, 1, 2});
    const auto hypre = make_pressure_solver(PressureMethod::hypre, problem.mesh, !open, 1e-12);
    const auto multigrid =
        make_pressure_solver(PressureMethod::multigrid, problem.mesh, !open, 1e-12);
    for (const double jump : {1.0, 1e3}) { // the second system is new to both
      fill_system(problem, random_medium(jump), open);
      EXPECT_LT(difference(solution(*hypre, problem), solution(*multigrid, problem)), 1e-9);
    }
    fill_system(problem, random_medium(1e3), open,
                5); // the same coefficients, something else asked
    EXPECT_LT(difference(solution(*hypre, problem), solution(*multigrid, problem)), 1e-9);
  }
}

TEST(HyprePressureSolver, StartsFromAGuessAndRefusesBadSystems) {
  PressureProblem problem =
      pressure_problem({12, 12, 12}, {1, 1, 1}, {false, false, false}, {1, 2, 2});
  fill_system(problem, uniform_medium, true);
  const auto solver = make_pressure_solver(PressureMethod::hypre, problem.mesh, false, 1e-10);
  BlockFields p = make_fields(problem.mesh);
  EXPECT_GT(solver->solve(problem.system, p).iterations, 4);
  EXPECT_LE(solver->solve(problem.system, p, FirstGuess::given).iterations, 1);
  problem.system.scale = 1e18;
  EXPECT_EQ(solver->solve(problem.system, p).iterations, 0);
  problem.system.scale = 0;
  if (!problem.mesh.local.empty() && problem.mesh.local.front().id == 0)
    problem.system.coefficient[0][0][problem.mesh.local[0].layout.at(1, 1, 1)] = std::nan("");
  EXPECT_THROW(solver->solve(problem.system, p), NumericalError);
}

} // namespace
} // namespace granflux::cfd
