// SPDX-FileCopyrightText: 2026 The GranFlux developers
// SPDX-License-Identifier: BSD-3-Clause

// Time of the pressure solver per cell and iteration beside the machine's triad, and the cost of
// new and of unchanged coefficients. A medium and a size a line:
//   bench_pressure_solver [hypre] [cells of a side ...]

#include <algorithm>
#include <cstdio>
#include <cstring>
#include <ctime>
#include <omp.h>
#include <string>

#include "../cfd/pressure_problem.hpp"
#include "triad.hpp"

namespace {

using namespace granflux::cfd;
using namespace granflux::cfd::testing;

/// Processor time over the number of threads: what others do on the machine does not count, but
/// for the cache and the memory that they use.
double seconds_of(const std::function<void()>& work) {
  const std::clock_t begin = std::clock();
  work();
  return double(std::clock() - begin) / CLOCKS_PER_SEC / omp_get_max_threads();
}

double least(const std::vector<double>& values) {
  return *std::min_element(values.begin(), values.end());
}

void report(PressureMethod method, const char* name, int n, const Medium& medium, bool open) {
  PressureProblem problem =
      pressure_problem({n, n, n}, {1, 1, 1}, {false, false, false}, {1, 1, 1});
  fill_system(problem, medium, open);
  const auto solver = make_pressure_solver(method, problem.mesh, problem.singular, 1e-10);
  BlockFields p = make_fields(problem.mesh);
  const double cells = double(n) * n * n;
  PressureReport done;
  std::vector<double> same, changed;
  for (int round = 0; round < std::max(3, 640 / n); ++round) {
    for (auto& block : problem.system.coefficient) // new coefficients: all a little larger
      for (Field& field : block)
        for (std::size_t c = 0; c < field.size(); ++c)
          field[std::ptrdiff_t(c)] *= 1.001;
    changed.push_back(seconds_of([&] { done = solver->solve(problem.system, p); }));
    same.push_back(seconds_of([&] { done = solver->solve(problem.system, p); }));
  }
  const double solve = least(same), with_setup = least(changed);
  const double triad_rate = granflux::bench::triad();
  std::printf("%-12s %4d  %3d iterations %8.2f ms  %6.2f ns a cell and iteration = %4.0f bytes of "
              "the triad's %.1f GB/s; new coefficients %6.2f ns a cell\n",
              name, n, done.iterations, 1e3 * with_setup, 1e9 * solve / cells / done.iterations,
              solve / cells / done.iterations * triad_rate * 1e9, triad_rate,
              1e9 * (with_setup - solve) / cells);
  std::fflush(stdout);
}

} // namespace

int main(int argc, char** argv) {
  MPI_Init(&argc, &argv);
  PressureMethod method = PressureMethod::multigrid;
  std::vector<int> sizes;
  for (int a = 1; a < argc; ++a)
    if (std::strcmp(argv[a], "hypre") == 0)
      method = PressureMethod::hypre;
    else
      sizes.push_back(std::stoi(argv[a]));
  if (sizes.empty())
    sizes = {32, 64, 128};
  for (const int n : sizes) {
    report(method, "uniform", n, uniform_medium, false);
    report(method, "bed 1e6", n, bed_medium(1e6, n), true);
    report(method, "bubbles 1e6", n, ball_medium(1e6, n), true);
    report(method, "touching 1e6", n, touching_medium(1e6, n), true);
    report(method, "binary 1e6", n, binary_medium(1e6), true);
    report(method, "random 1e6", n, random_medium(1e6), true);
  }
  MPI_Finalize();
}
