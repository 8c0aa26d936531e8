// SPDX-FileCopyrightText: 2026 The GranFlux developers
// SPDX-License-Identifier: BSD-3-Clause

// The multigrid pressure solver against Eigen's direct one, against itself on other cuts, ranks
// and threads, and in the number of its iterations.

#include <gtest/gtest.h>
#include <omp.h>

#include <granflux/cfd/error.hpp>
#include <granflux/cfd/multigrid.hpp>
#include <granflux/cfd/row_sweep.hpp>

#include "pressure_problem.hpp"

namespace granflux::cfd {
namespace {

using namespace testing;

constexpr std::array<bool, 3> closed{false, false, false};
constexpr Vec3 cubes{1, 1, 1};

std::vector<double> solution(PressureProblem& problem, double tolerance,
                             PressureReport* report = nullptr) {
  const auto solver = make_multigrid_pressure_solver(problem.mesh, problem.singular, tolerance);
  BlockFields p = make_fields(problem.mesh, 3); // what it holds must not matter
  const PressureReport done = solver->solve(problem.system, p);
  if (report)
    *report = done;
  return on_box(problem, p);
}

std::vector<double> direct_solution(PressureProblem& problem) {
  BlockFields p = make_fields(problem.mesh);
  make_eigen_pressure_solver(problem.mesh, problem.singular, 1e-14)->solve(problem.system, p);
  return on_box(problem, p);
}

struct Shape {
  const char* name;
  Index3 cells, blocks;
  std::array<bool, 3> periodic;
  bool open;
};

class MultigridShape : public ::testing::TestWithParam<Shape> {};

TEST_P(MultigridShape, AgreesWithTheDirectSolver) {
  const Shape& shape = GetParam();
  PressureProblem problem =
      pressure_problem(shape.cells, {1, 1.5, 0.8}, shape.periodic, shape.blocks);
  fill_system(problem, random_medium(1e3), shape.open);
  PressureReport report;
  const std::vector<double> p = solution(problem, 1e-13, &report);
  EXPECT_GT(report.iterations, 0);
  EXPECT_LE(report.residual, 1e-13);
  EXPECT_LT(difference(p, direct_solution(problem)), 1e-10);
}

INSTANTIATE_TEST_SUITE_P(
    Shapes, MultigridShape,
    ::testing::Values(Shape{"even_closed", {16, 12, 8}, {2, 2, 1}, closed, false},
                      Shape{"even_open", {16, 12, 8}, {1, 2, 2}, closed, true},
                      Shape{"odd_sizes", {13, 11, 9}, {2, 2, 1}, closed, false},
                      Shape{"odd_blocks", {14, 10, 15}, {2, 1, 5}, closed, true},
                      Shape{"all_periodic", {12, 8, 10}, {2, 2, 1}, {true, true, true}, false},
                      Shape{"odd_periodic", {11, 9, 13}, {2, 1, 2}, {true, true, false}, true},
                      Shape{"one_cell_wall", {40, 1, 24}, {2, 1, 2}, closed, true},
                      Shape{
                          "one_cell_periodic", {40, 24, 1}, {4, 1, 1}, {false, true, true}, false},
                      Shape{"a_line", {1, 1, 700}, {1, 1, 4}, {true, false, false}, true},
                      Shape{"many_blocks", {16, 16, 16}, {8, 8, 8}, closed, false}),
    [](const auto& one) { return std::string(one.param.name); });

TEST(Multigrid, TakesBlocksThatAreTurned) {
  for (const bool odd : {false, true}) {
    const Index3 cells = odd ? Index3{13, 11, 10} : Index3{12, 12, 8};
    PressureProblem plain = pressure_problem(cells, cubes, {false, true, false}, {2, 2, 1});
    fill_system(plain, random_medium(100), true);
    PressureProblem turned = pressure_problem(cells, cubes, {false, true, false}, {2, 2, 1});
    turn_block(turned, 1, {1, 2, 0}, {0, 0, 0});
    turn_block(turned, 2, {1, 0, 2}, {1, 0, 0});
    turn_block(turned, 3, {0, 1, 2}, {1, 1, 0});
    fill_system(turned, random_medium(100), true);
    PressureReport report, plain_report;
    const std::vector<double> p = solution(turned, 1e-14, &report);
    EXPECT_LT(difference(p, solution(plain, 1e-14, &plain_report)), 1e-12);
    EXPECT_LT(difference(p, direct_solution(plain)), 1e-11);
    EXPECT_LE(report.iterations, plain_report.iterations + 3);
  }
}

TEST(Multigrid, SameForAnyCutAndAnyNumberOfRanks) {
  const Index3 cells{24, 24, 24};
  PressureProblem whole = pressure_problem(cells, cubes, closed, {1, 1, 1}, MPI_COMM_SELF);
  fill_system(whole, random_medium(100), false);
  // Cuts at even cells: the same cells join, so a loose tolerance already gives the same but for
  // the rounding of the cycle: single precision's share of the error that is left.
  PressureReport first;
  const std::vector<double> loose = solution(whole, 1e-8, &first);
  for (const Index3& blocks : {Index3{2, 2, 1}, {1, 2, 3}, {3, 3, 3}}) {
    PressureProblem cut = pressure_problem(cells, cubes, closed, blocks);
    fill_system(cut, random_medium(100), false);
    PressureReport report;
    EXPECT_LT(difference(solution(cut, 1e-8, &report), loose), 1e-12);
    EXPECT_EQ(report.iterations, first.iterations);
  }
  // Elsewhere the tolerance decides.
  const std::vector<double> tight = solution(whole, 1e-15);
  for (const Index3& blocks : {Index3{5, 1, 1}, {1, 7, 2}}) {
    PressureProblem cut = pressure_problem(cells, cubes, closed, blocks);
    fill_system(cut, random_medium(100), false);
    EXPECT_LT(difference(solution(cut, 1e-15), tight), 1e-12);
  }
}

TEST(Multigrid, SameBitsForAnyNumberOfThreadsAndInEveryRun) {
  PressureProblem problem = pressure_problem({32, 24, 30}, cubes, closed, {1, 1, 4});
  fill_system(problem, random_medium(100), true);
  const int threads = omp_get_max_threads();
  omp_set_num_threads(1);
  const std::vector<double> one = solution(problem, 1e-10);
  for (const int n : {2, 3}) {
    omp_set_num_threads(n);
    EXPECT_EQ(solution(problem, 1e-10), one) << n << " threads";
  }
  omp_set_num_threads(threads);
  // A solver that has solved something else before gives the same as a fresh one.
  const auto used = make_multigrid_pressure_solver(problem.mesh, problem.singular, 1e-10);
  PressureProblem other = pressure_problem({32, 24, 30}, cubes, closed, {1, 1, 4});
  fill_system(other, bed_medium(1e3, 30), true, 9);
  BlockFields p = make_fields(problem.mesh);
  used->solve(other.system, p);
  used->solve(problem.system, p);
  EXPECT_EQ(on_box(problem, p), one);
}

TEST(Multigrid, CycleIsSymmetricAndPositive) {
  struct Case {
    Medium medium;
    bool open;
    Vec3 spacing;
    Index3 blocks; ///< one: swept at once; several: step by step
  };
  for (const Case& one : {Case{random_medium(1e6), true, cubes, {2, 1, 2}},
                          Case{ball_medium(1e6, 20), false, cubes, {2, 1, 2}},
                          Case{ball_medium(1e6, 20), false, cubes, {1, 1, 1}},
                          Case{bed_medium(1e6, 20), true, {20, 1, 1}, {1, 1, 1}}}) {
    const bool whole = one.blocks == Index3{1, 1, 1};
    PressureProblem problem = pressure_problem({20, 18, 21}, one.spacing, {false, !whole, false},
                                               one.blocks, whole ? MPI_COMM_SELF : MPI_COMM_WORLD);
    fill_system(problem, one.medium, one.open, 3);
    const BlockFields v = problem.system.rhs;
    fill_system(problem, one.medium, one.open, 4);
    const BlockFields w = problem.system.rhs;
    Multigrid multigrid(problem.mesh, problem.singular);
    multigrid.setup(problem.system);
    const auto each = [&](auto&& body) {
      for (std::size_t b = 0; b < problem.mesh.local.size(); ++b) {
        const Layout& layout = problem.mesh.local[b].layout;
        for_rows(layout, [&](std::ptrdiff_t row, int j, int k) {
          for (int i = 0; i < layout.cells[0]; ++i)
            body(b, row + i, multigrid.layout(b).at(i, j, k));
        });
      }
    };
    const auto cycle = [&](const BlockFields& residual) {
      each([&](std::size_t b, std::ptrdiff_t c, std::ptrdiff_t at) {
        multigrid.residual(b)[at] = float(residual[b][c]);
      });
      multigrid.apply();
      BlockFields out = make_fields(problem.mesh);
      each([&](std::size_t b, std::ptrdiff_t c, std::ptrdiff_t at) {
        out[b][c] = multigrid.correction(b)[at];
      });
      return out;
    };
    const auto product = [&](const BlockFields& a, const BlockFields& b) {
      double sum = 0;
      for_each_cell(problem.mesh, [&](std::size_t block, std::ptrdiff_t c, const Vec3&) {
        sum += a[block][c] * b[block][c];
      });
      MPI_Allreduce(MPI_IN_PLACE, &sum, 1, MPI_DOUBLE, MPI_SUM, problem.mesh.comm);
      return sum;
    };
    const BlockFields v_image = cycle(v), w_image = cycle(w);
    const double vv = product(v, v_image), ww = product(w, w_image);
    EXPECT_GT(vv, 0);
    EXPECT_GT(ww, 0);
    constexpr double rounding = 2e-7; // of single precision
    EXPECT_NEAR(product(v, w_image), product(w, v_image), rounding * std::sqrt(vv * ww));
  }
}

int iterations(int n, const Vec3& spacing, const Medium& medium, bool open) {
  PressureProblem problem = pressure_problem({n, n, n}, spacing, closed, {2, 2, 1});
  fill_system(problem, medium, open);
  PressureReport report;
  solution(problem, 1e-10, &report);
  return report.iterations;
}

TEST(Multigrid, IterationsDoNotGrowWithTheMesh) {
  for (const bool open : {false, true}) {
    const int coarse = iterations(32, cubes, uniform_medium, open);
    const int fine = iterations(64, cubes, uniform_medium, open);
    EXPECT_LE(coarse, 9);
    EXPECT_LE(fine, coarse + 2);
  }
}

TEST(Multigrid, StretchedCellsAndStrongJumpsTakeFewIterations) {
  const int n = 32;
  for (const Vec3& spacing :
       {cubes, Vec3{20, 1, 1}, Vec3{1, 20, 20}, Vec3{1, 1, 20}, Vec3{1, 5, 20}}) {
    EXPECT_LE(iterations(n, spacing, uniform_medium, false), 10);
    EXPECT_LE(iterations(n, spacing, bed_medium(1e6, n), true), 14);
    EXPECT_LE(iterations(n, spacing, ball_medium(1e-6, n), false), 24);
    EXPECT_LE(iterations(n, spacing, ball_medium(1e6, n), true), 24);
  }
}

TEST(Multigrid, RoundingOfTheRightHandSideIsNotSolvedFor) {
  PressureProblem problem = pressure_problem({12, 12, 12}, cubes, closed, {1, 2, 2});
  fill_system(problem, uniform_medium, true);
  problem.system.scale = 1e18;
  PressureReport report;
  solution(problem, 1e-10, &report);
  EXPECT_EQ(report.iterations, 0);
  problem.system.scale = 1e9;
  solution(problem, 1e-10, &report);
  EXPECT_GT(report.iterations, 0);
  EXPECT_GT(report.residual, 1e-10);
  for (Field& field : problem.system.rhs)
    field.fill(0);
  problem.system.scale = 0;
  for (const double value : solution(problem, 1e-10, &report))
    EXPECT_EQ(value, 0);
  EXPECT_EQ(report.iterations, 0);
}

void multiply(PressureProblem& problem, double coefficients, double rhs) {
  for (auto& block : problem.system.coefficient)
    for (Field& field : block)
      for (std::size_t c = 0; c < field.size(); ++c)
        field[std::ptrdiff_t(c)] *= coefficients;
  for (Field& field : problem.system.rhs)
    for (std::size_t c = 0; c < field.size(); ++c)
      field[std::ptrdiff_t(c)] *= rhs;
}

TEST(Multigrid, SizeOfTheNumbersDoesNotMatter) {
  // Powers of 2 round nothing: the same bits, though single precision ends at 2^127.
  PressureProblem problem = pressure_problem({16, 14, 12}, cubes, closed, {1, 2, 2});
  fill_system(problem, random_medium(1e6), true);
  PressureReport plain_report;
  const std::vector<double> plain = solution(problem, 1e-12, &plain_report);
  for (const auto& [coefficients, rhs] :
       {std::pair{-900, -920}, {900, 880}, {-700, 10}, {500, -300}, {3, -60}}) {
    fill_system(problem, random_medium(1e6), true);
    multiply(problem, std::ldexp(1, coefficients), std::ldexp(1, rhs));
    PressureReport report;
    std::vector<double> p = solution(problem, 1e-12, &report);
    for (double& value : p)
      value = std::ldexp(value, coefficients - rhs);
    EXPECT_EQ(p, plain) << coefficients << ", " << rhs;
    EXPECT_EQ(report.iterations, plain_report.iterations);
  }
}

TEST(Multigrid, StrongJumpsAreSolvedToTheTightestTolerance) {
  for (const Medium& medium : {random_medium(1e6), ball_medium(1e6, 16), ball_medium(1e-6, 16)})
    for (const bool open : {false, true}) {
      PressureProblem problem = pressure_problem({16, 16, 16}, cubes, closed, {1, 2, 2});
      fill_system(problem, medium, open);
      PressureReport report;
      const std::vector<double> p = solution(problem, 1e-13, &report);
      EXPECT_LE(report.residual, 1e-13);
      constexpr double of_field = 1e-13 * 1e6; // what a residual means where conductivity is least
      EXPECT_LT(difference(p, direct_solution(problem)), of_field);
    }
}

TEST(Multigrid, StartsFromAGuess) {
  for (const bool open : {false, true}) {
    PressureProblem problem =
        pressure_problem({20, 18, 16}, cubes, {true, false, false}, {1, 2, 2});
    fill_system(problem, random_medium(100), open);
    const auto solver = make_multigrid_pressure_solver(problem.mesh, problem.singular, 1e-13);
    BlockFields p = make_fields(problem.mesh);
    const int from_zero = solver->solve(problem.system, p).iterations;
    const std::vector<double> exact = on_box(problem, p);
    // The solution: nothing is left to do but for its own rounding.
    EXPECT_LE(solver->solve(problem.system, p, FirstGuess::given).iterations, 1);
    // Nearly the solution, and off by a constant where that does not matter.
    for_each_cell(problem.mesh, [&](std::size_t b, std::ptrdiff_t c, const Vec3& x) {
      p[b][c] = p[b][c] * (1 + 1e-6 * std::sin(x.x)) + (open ? 0 : 3);
    });
    EXPECT_LE(solver->solve(problem.system, p, FirstGuess::given).iterations, from_zero - 3);
    EXPECT_LT(difference(on_box(problem, p), exact), 1e-11);
    // Far off.
    for (Field& field : p)
      field.fill(1e3);
    solver->solve(problem.system, p, FirstGuess::given);
    EXPECT_LT(difference(on_box(problem, p), exact), 1e-11);
  }
}

TEST(Multigrid, KnowsWhetherCoefficientsHaveChanged) {
  PressureProblem problem = pressure_problem({20, 20, 20}, cubes, closed, {1, 2, 2});
  fill_system(problem, random_medium(100), true);
  const auto used = make_multigrid_pressure_solver(problem.mesh, problem.singular, 1e-10);
  BlockFields p = make_fields(problem.mesh);
  used->solve(problem.system, p);
  fill_system(problem, random_medium(100), true, 8); // another right-hand side
  used->solve(problem.system, p);
  EXPECT_EQ(on_box(problem, p), solution(problem, 1e-10));
  // One coefficient of one rank, inside and on the open side.
  for (const bool top : {false, true}) {
    for (std::size_t b = 0; b < problem.mesh.local.size(); ++b)
      if (problem.mesh.local[b].id == 3) {
        const Layout& layout = problem.mesh.local[b].layout;
        problem.system.coefficient[b][top ? 2 : 0][layout.at(2, 2, top ? layout.cells[2] : 2)] *=
            1.5;
      }
    used->solve(problem.system, p);
    PressureReport report;
    EXPECT_LT(difference(on_box(problem, p), solution(problem, 1e-10, &report)), 1e-15);
  }
}

/// Position of cell (1,1,1) of block 0 on the rank that has it, else nothing.
std::vector<std::ptrdiff_t> a_cell(const Mesh& mesh) {
  if (mesh.local.empty() || mesh.local.front().id != 0)
    return {};
  return {mesh.local.front().layout.at(1, 1, 1)};
}

TEST(Multigrid, BadSystemsAreErrorsOnAllRanks) {
  PressureProblem problem = pressure_problem({12, 12, 12}, cubes, closed, {1, 2, 2});
  fill_system(problem, uniform_medium, true);
  for (const std::ptrdiff_t c : a_cell(problem.mesh))
    problem.system.rhs[0][c] = std::nan("");
  EXPECT_THROW(solution(problem, 1e-10), NumericalError);
  fill_system(problem, uniform_medium, true);
  for (const std::ptrdiff_t c : a_cell(problem.mesh))
    problem.system.coefficient[0][0][c] = std::nan("");
  EXPECT_THROW(solution(problem, 1e-10), NumericalError);
  fill_system(problem, uniform_medium, true);
  for (const std::ptrdiff_t c : a_cell(problem.mesh))
    for (std::size_t d = 0; d < 3; ++d) {
      problem.system.coefficient[0][d][c] = 0;
      problem.system.coefficient[0][d][c + problem.mesh.local[0].layout.stride[d]] = 0;
    }
  EXPECT_THROW(solution(problem, 1e-10), NumericalError);
}

TEST(Multigrid, GasFlowIsTheSameAsWithTheDirectSolver) {
  const auto flow = [](PressureMethod method, int& most_iterations) {
    GasCase c = box_case({12, 10, 14}, {1, 1, 1.4}, {true, false, false}, {2, 2, 1});
    boundary(c, "z_low").kind = BoundaryKind::inlet;
    boundary(c, "z_low").velocity = {0, 0, 1};
    boundary(c, "z_high").kind = BoundaryKind::outlet;
    c.numerics.pressure_solver = method;
    c.numerics.pressure_tolerance = 1e-14;
    c.numerics.viscous_tolerance = 1e-14;
    const Mesh mesh = make_mesh(c, MPI_COMM_WORLD);
    GasSolver gas(mesh, c);
    MomentumExchange drag = make_exchange(mesh);
    for_each_cell(mesh, [&](std::size_t b, std::ptrdiff_t p, const Vec3& x) {
      drag.drag_coefficient[b][p] = x.z < 0.7 ? 1e4 : 0; // a bed in the lower half
    });
    most_iterations = 0;
    for (int step = 0; step < 5; ++step)
      most_iterations = std::max(
          most_iterations, gas.advance(0.01, make_fields(mesh, 1), &drag).pressure_iterations);
    std::vector<double> state;
    for_each_cell(mesh, [&](std::size_t b, std::ptrdiff_t p, const Vec3&) {
      for (std::size_t m = 0; m < 3; ++m)
        state.push_back(gas.velocity()[b][m][p]);
    });
    return state;
  };
  int direct_iterations = 0, multigrid_iterations = 0;
  const std::vector<double> direct = flow(PressureMethod::direct, direct_iterations);
  const std::vector<double> multigrid = flow(PressureMethod::multigrid, multigrid_iterations);
  EXPECT_EQ(direct_iterations, 0);
  EXPECT_GT(multigrid_iterations, 0);
  EXPECT_LE(multigrid_iterations, 24);
  EXPECT_LT(difference(multigrid, direct), 1e-11);
}

/// Velocity (in m/s, about 1) and pressure over its largest value, cell by cell of the box.
std::vector<double> bed_flow(const Index3& blocks) {
  const Index3 cells{13, 10, 15};
  GasCase c = box_case(cells, {13, 10, 15}, {true, false, false}, blocks);
  boundary(c, "z_low").kind = BoundaryKind::inlet;
  boundary(c, "z_low").velocity = {0, 0, 1};
  boundary(c, "z_high").kind = BoundaryKind::outlet;
  c.numerics.pressure_solver = PressureMethod::multigrid;
  c.numerics.pressure_tolerance = 1e-15;
  c.numerics.viscous_tolerance = 1e-15;
  const Mesh mesh = make_mesh(c, MPI_COMM_WORLD);
  GasSolver gas(mesh, c);
  MomentumExchange drag = make_exchange(mesh);
  for_each_cell(mesh, [&](std::size_t b, std::ptrdiff_t p, const Vec3& x) {
    drag.drag_coefficient[b][p] = x.z < 7 ? 1e3 * (1 + std::sin(x.x)) : 0;
  });
  for (int step = 0; step < 5; ++step)
    gas.advance(0.1, make_fields(mesh, 1), &drag);
  const auto n = std::size_t(cells[0] * cells[1] * cells[2]);
  std::vector<double> state(4 * n, 0.0);
  for_each_cell(mesh, [&](std::size_t b, std::ptrdiff_t p, const Vec3& x) {
    const std::size_t at =
        std::size_t(x.x) + 13 * (std::size_t(x.y) + 10 * std::size_t(x.z)); // cells are 1 m wide
    for (std::size_t m = 0; m < 3; ++m)
      state[4 * at + m] = gas.velocity()[b][m][p];
    state[4 * at + 3] = gas.pressure()[b][p];
  });
  MPI_Allreduce(MPI_IN_PLACE, state.data(), int(state.size()), MPI_DOUBLE, MPI_SUM, mesh.comm);
  double most = 0;
  for (std::size_t at = 0; at < n; ++at)
    most = std::max(most, std::abs(state[4 * at + 3]));
  for (std::size_t at = 0; at < n; ++at)
    state[4 * at + 3] /= most;
  return state;
}

TEST(Multigrid, FlowIsTheSameForCutsAnywhere) {
  const std::vector<double> one = bed_flow({1, 1, 4});
  for (const Index3& blocks : {Index3{2, 2, 1}, {1, 1, 5}, {3, 1, 2}})
    EXPECT_LT(difference(bed_flow(blocks), one), 1e-12);
}

} // namespace
} // namespace granflux::cfd
