// SPDX-FileCopyrightText: 2026 The GranFlux developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <array>
#include <vector>

#include <granflux/cfd/mesh.hpp>

namespace granflux::cfd {

/// How the cells of a block along one direction join: cells 2I - shift and 2I - shift + 1 become
/// coarse cell I. With shift 1 the first cell stays alone, and the last may.
struct Pairing {
  bool pairs = false; ///< false: every cell stays alone
  int shift = 0;

  [[nodiscard]] int coarse(int i) const { return pairs ? (i + shift) / 2 : i; }
  /// First fine cell of coarse cell I; for I one past the last, the number n of fine cells.
  [[nodiscard]] int first(int I, int n) const {
    return pairs ? std::clamp(2 * I - shift, 0, n) : I;
  }
  [[nodiscard]] int width(int I, int n) const { return first(I + 1, n) - first(I, n); }
};

using Pairings = std::vector<std::array<Pairing, 3>>; ///< per block of the mesh and direction

/// Chooses, level by level, the directions in which cells join, so that point smoothing does the
/// rest: those in which cells are coupled most strongly. Couplings are judged by the mesh (mean
/// conductance of a direction's faces), once; a medium that varies, varies alike in all
/// directions.
///
/// Blocks that lie side by side must pair alike along their common side. On a lattice a direction
/// is coarsened in all blocks or none; elsewhere in all blocks that are side by side.
class Coarsening {
public:
  /// Collective: the conductances are those of all ranks.
  explicit Coarsening(const Mesh& finest);

  /// Pairs for the next level below `mesh`, the last one that was made with this object; nothing
  /// pairs where no direction can be coarsened.
  Pairings next(const Mesh& mesh);

private:
  bool by_axis_; ///< lattice: what holds for a direction holds for all blocks
  std::vector<std::array<double, 3>> strength_;
};

/// A direction of one cell that is its own neighbour: its faces couple nothing.
bool closed_on_itself(const Mesh& mesh, int block, int direction);

/// The mesh of joined cells: block sizes, ranks and links, without geometry or boundaries.
Mesh join_cells(const Mesh& mesh, const Pairings& pairings);

} // namespace granflux::cfd
