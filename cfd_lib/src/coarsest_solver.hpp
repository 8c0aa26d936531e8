// SPDX-FileCopyrightText: 2026 The GranFlux developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>

#include "multigrid_level.hpp"

namespace granflux::cfd {

/// Direct solver (LDL^T by Eigen) for the few cells of the coarsest level: factorised once per
/// time step, solved several times. Every rank gathers and solves the whole of it, which costs
/// one message instead of two.
class CoarsestSolver {
public:
  CoarsestSolver(const Mesh& mesh, bool singular);
  ~CoarsestSolver();

  /// Collective. Throws NumericalError on all ranks if the matrix is not positive definite.
  void factorise(const Level& level);
  /// Collective: x = inverse(A) rhs; of zero mean, and for the part of rhs of zero mean, where A
  /// is singular.
  void solve(Level& level);

private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

} // namespace granflux::cfd
