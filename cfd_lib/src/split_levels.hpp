// SPDX-FileCopyrightText: 2026 The GranFlux developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>
#include <vector>

#include "multigrid_level.hpp"

namespace granflux::cfd {

/// The levels below a structured one where cells that lie in one coarse cell are coupled too badly
/// to share its unknown: there the coarse cell is split, and so are, where need be, those below.
class SplitLevels {
public:
  /// Below levels[from], in the cells of the levels that follow it, down to `largest_coarsest`
  /// nodes where they allow it. Collective; throws as CoarsestSolver.
  SplitLevels(const std::vector<std::unique_ptr<Level>>& levels, std::size_t from,
              long largest_coarsest, bool singular);
  ~SplitLevels();

  /// What stands in for the next level: its right-hand side receives the residual of levels[from]
  /// cell by cell, and its x holds the correction after correct().
  [[nodiscard]] Level& cells();
  /// Collective.
  void correct();

  /// Nodes of all ranks on each level.
  [[nodiscard]] std::vector<long> sizes() const;

private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

} // namespace granflux::cfd
