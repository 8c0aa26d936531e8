// SPDX-FileCopyrightText: 2026 The GranFlux developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include <Eigen/SparseCholesky>

namespace granflux::cfd {

/// LDL^T of a few equations without mass, singular where no pressure is given anywhere.
class DirectFactor {
public:
  using Entries = std::vector<Eigen::Triplet<double>>;

  explicit DirectFactor(bool singular) : singular_(singular) {}

  /// From the lower triangle; entries of the same place are summed. `same_places`: they lie where
  /// they lay before. Throws NumericalError if the matrix is not positive definite.
  void factorise(int equations, const Entries& lower, bool same_places);
  /// x = inverse(A) rhs; of zero mean, and for the part of rhs of zero mean, where A is singular.
  [[nodiscard]] Eigen::VectorXd solve(Eigen::VectorXd rhs) const;

private:
  bool singular_;
  Eigen::SparseMatrix<double> lower_;
  Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> factor_;
};

} // namespace granflux::cfd
