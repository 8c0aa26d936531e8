// SPDX-FileCopyrightText: 2026 The GranFlux developers
// SPDX-License-Identifier: BSD-3-Clause
#include "direct_factor.hpp"

#include <granflux/cfd/error.hpp>

namespace granflux::cfd {

void DirectFactor::factorise(int equations, const Entries& lower, bool same_places) {
  lower_.resize(equations, equations);
  lower_.setFromTriplets(lower.begin(), lower.end());
  if (singular_) { // ties the first unknown to 0; the mean is taken off afterwards
    double& first = lower_.coeffRef(0, 0);
    first = first > 0 ? 2 * first : 1;
  }
  if (!same_places)
    factor_.analyzePattern(lower_);
  factor_.factorize(lower_);
  if (factor_.info() != Eigen::Success)
    throw NumericalError("pressure equation: the coarsest level could not be factorised; a "
                         "coefficient is not a number, or a part of the gas has no opening");
}

Eigen::VectorXd DirectFactor::solve(Eigen::VectorXd rhs) const {
  if (singular_)
    rhs.array() -= rhs.mean();
  Eigen::VectorXd solution = factor_.solve(rhs);
  if (singular_)
    solution.array() -= solution.mean();
  return solution;
}

} // namespace granflux::cfd
