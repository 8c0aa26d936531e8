// SPDX-FileCopyrightText: 2026 The GranFlux developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <memory>

#include <granflux/cfd/mesh.hpp>

namespace granflux::cfd {

/// sum over the six faces of a cell of  coefficient * (p_neighbour - p_cell)  =  rhs_cell.
/// A face on a boundary has coefficient 0, or, where the pressure is given, that of a neighbour
/// at pressure 0 (its value is already in the right-hand side).
struct PressureSystem {
  std::vector<std::array<Field, 3>> coefficient; ///< per local block and direction, on low faces
  BlockFields rhs;
  /// Norm over all cells of the numbers that rhs is the sum of: a residual below their rounding
  /// is as good as none. 0 where not known.
  double scale = 0;
};

struct PressureReport {
  int iterations = 0;  ///< 0 for a direct solve
  double residual = 0; ///< norm of the remaining error in the equations over that of rhs
};

/// What a solver that iterates starts from.
enum class FirstGuess {
  zero,
  given ///< what `p` holds on interior cells
};

class PressureSolver {
public:
  virtual ~PressureSolver() = default;
  /// Collective. `p` receives the solution on interior cells. A singular system (no pressure given
  /// anywhere) gets the solution of zero mean. When it ends does not depend on the first guess.
  /// Coefficients that are those of the system before are recognised and cost next to nothing.
  virtual PressureReport solve(const PressureSystem& system, BlockFields& p,
                               FirstGuess guess = FirstGuess::zero) = 0;
};

/// Gathers the system on rank 0 and solves it there with Eigen: directly (LDL^T) up to
/// `largest_direct` cells, else by conjugate gradients with incomplete Cholesky to `tolerance`.
/// The same bits for any number of ranks and threads.
std::unique_ptr<PressureSolver> make_eigen_pressure_solver(const Mesh& mesh, bool singular,
                                                           double tolerance);

/// Conjugate gradients preconditioned by multigrid (multigrid.hpp), to a residual of `tolerance`
/// of the right-hand side or the rounding of its scale. Throws NumericalError on all ranks where
/// it does not get there. The same bits for any number of threads and in every run; for any cut
/// into blocks and ranks the same to rounding where the cuts let the same cells join, else to the
/// tolerance.
std::unique_ptr<PressureSolver> make_multigrid_pressure_solver(const Mesh& mesh, bool singular,
                                                               double tolerance);

/// Conjugate gradients preconditioned by hypre's BoomerAMG, to measure against; ends like the
/// multigrid solver. Throws ConfigError where hypre was not found when this library was built.
std::unique_ptr<PressureSolver> make_hypre_pressure_solver(const Mesh& mesh, bool singular,
                                                           double tolerance);

enum class PressureMethod {
  automatic, ///< the faster one: direct up to 1000 cells, multigrid beyond
  direct,    ///< make_eigen_pressure_solver
  multigrid, ///< make_multigrid_pressure_solver
  hypre      ///< make_hypre_pressure_solver
};

std::unique_ptr<PressureSolver> make_pressure_solver(PressureMethod method, const Mesh& mesh,
                                                     bool singular, double tolerance);

} // namespace granflux::cfd
