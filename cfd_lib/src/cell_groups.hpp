// SPDX-FileCopyrightText: 2026 The GranFlux developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

namespace granflux::cfd {

/// Which of the nodes that meet in one coarse cell share a coarse unknown. The smoother must be
/// able to do what a shared unknown cannot: to move two groups of nodes against each other. How
/// well it can is their coupling over the harmonic sum of their diagonals, 1/3 in cubes of a
/// uniform medium; where it is small, error of that shape is left, one iteration of conjugate
/// gradients or two for each place. Quality of aggregates as in Notay, SIAM J. Sci. Comput. 34
/// (2012) A2288.
class CellGroups {
public:
  /// For `nodes` nodes that couple to nothing; their diagonals are set one by one.
  void start(int nodes);
  void set_diagonal(int node, double diagonal) { diagonal_[std::size_t(node)] = diagonal; }
  void add_coupling(int a, int b, double coupling);
  /// Joins nodes and groups, best coupled first, while that is at least `least`; returns the number
  /// of groups.
  int join(double least);
  /// Group of a node, numbered by their first nodes.
  [[nodiscard]] int of(int node) const { return group_[std::size_t(node)]; }

private:
  [[nodiscard]] double& coupling(int a, int b) {
    return coupling_[std::size_t(a) * diagonal_.size() + std::size_t(b)];
  }

  std::vector<double> diagonal_, inverse_, coupling_;
  std::vector<int> group_, heads_;
};

} // namespace granflux::cfd
