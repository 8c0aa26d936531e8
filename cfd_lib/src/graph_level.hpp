// SPDX-FileCopyrightText: 2026 The GranFlux developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <vector>

#include "graph_halo.hpp"
#include "multigrid_level.hpp"

namespace granflux::cfd {

/// A coarse level where cells were split: a cell holds one node or more, and a node has neighbours
/// in the cells around and in its own. Nodes are numbered by blocks and cells, i fastest; those of
/// other ranks follow, and last comes `outside`, where the correction is 0.
struct GraphLevel {
  /// Where a neighbour lies: over side 2 d + high of the cell, or in the cell itself.
  static constexpr std::uint8_t within = 6;

  /// The nodes that `fine` is joined into, of the cells of `place`; groups are coupled at least as
  /// well as `least` (CellGroups). Collective; writes x of `cells`, which stands in for `fine` cell
  /// by cell.
  GraphLevel(const Level& fine, Level& cells, const Level& place, double least);
  GraphLevel(const GraphLevel& fine, const Level& place, double least);

  /// The residual of the finer level, summed into the right-hand side.
  void restrict_from(const Level& cells);
  void restrict_from(GraphLevel& fine);
  /// The correction, as x of `cells`, or added to x.
  void correct(Level& cells) const;
  void correct(GraphLevel& fine) const;
  /// Chebyshev smoothing of A x = rhs. Collective.
  void smooth(Start start);

  [[nodiscard]] int outside() const { return int(x.size()) - 1; }

  const Level& place;
  int own = 0;
  long total = 0; ///< nodes of all ranks
  GraphHalo halo;
  std::vector<int> first_of_cell; ///< of the cells of all local blocks, then the end
  std::vector<int> row;           ///< first edge of an own node, then the end
  std::vector<int> neighbour;
  std::vector<float> coupling;
  std::vector<std::uint8_t> side;
  std::vector<float> inverse_diagonal; ///< 0 where nothing couples to a node
  std::vector<float> rhs, x, spare;

  /// Finer nodes, or positions in the finer level's fields one block after the other, that a node
  /// is made of.
  std::vector<int> first_member, member;
  std::vector<int> joined; ///< the reverse; behind boundaries `outside`

private:
  template <class Source> void join(const Source& source, double least);
  [[nodiscard]] float left_over(std::ptrdiff_t i, const std::vector<float>& of) const;
};

/// In how many coarse cells of `coarse` of this rank cells of `fine` meet that are coupled worse
/// than `least` (CellGroups).
long badly_joined(const Level& fine, const Level& coarse, double least);

} // namespace granflux::cfd
