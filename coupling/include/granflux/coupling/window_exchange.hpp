// SPDX-FileCopyrightText: 2026 The GranFlux developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <span>
#include <vector>

#include <granflux/cfd/mesh.hpp>
#include <granflux/coupling/window.hpp>

namespace granflux::coupling {

/// Moves fields between the windows of the ranks and the gas blocks on their owners, point to
/// point: each rank works out from the lattice which blocks its window overlaps, and an owner
/// learns of its partners by a sparse consensus. Nothing grows with the number of ranks or with
/// the size of the whole grid.
class WindowExchange {
public:
  explicit WindowExchange(const cfd::Mesh& mesh);

  /// Sets this rank's window. The pattern is built anew where any rank's window has changed.
  /// Collective.
  void bind(const Window& window);

  /// Adds window values to the blocks under them, in order of rank. `from` holds to.size() numbers
  /// for each cell of the window; they go in one message to each owner. Collective.
  void deposit(std::span<const double> from, std::span<cfd::BlockFields* const> to);

  /// Copies block fields to the windows above them: from.size() numbers a cell. Collective.
  void sample(std::span<const cfd::BlockFields* const> from, std::span<double> to);

private:
  /// Part of a window over one block.
  struct Overlap {
    int block = 0;        ///< index into Mesh::blocks
    cfd::Index3 window{}; ///< first cell, relative to the window
    cfd::Index3 cell{};   ///< first cell, in the block
    cfd::Index3 count{};
  };
  /// What this rank shares with another one, in an order both of them know.
  struct Partner {
    int rank = 0;
    std::vector<Overlap> overlaps;
    std::size_t cells = 0;
    std::vector<double> buffer;
  };

  [[nodiscard]] std::vector<Partner> find_owners() const;
  [[nodiscard]] std::vector<Partner> find_users() const;
  /// Calls row(local block, position in it, position in the window, length) for every run of
  /// i-neighbours shared with a partner, in the order both sides know. The block counts for users
  /// only (-1 where an owner's is not local), the position in the window for owners only.
  template <class Row> void rows(const Partner& partner, Row&& row) const;

  const cfd::Mesh& mesh_;
  std::vector<int> local_; ///< of every block: index into Mesh::local, -1 elsewhere
  Window window_;
  bool bound_ = false;
  std::vector<Partner> owners_; ///< of blocks under this rank's window, by rank
  std::vector<Partner> users_;  ///< whose windows lie over this rank's blocks, by rank
};

} // namespace granflux::coupling
