// SPDX-FileCopyrightText: 2026 The GranFlux developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <span>
#include <vector>

#include <granflux/cfd/mesh.hpp>
#include <granflux/coupling/block_stack.hpp>
#include <granflux/coupling/window.hpp>

namespace granflux::coupling {

/// Moves fields between the windows of the ranks and the gas blocks on their owners, point to
/// point: each rank works out from the mesh which blocks its window overlaps, and an owner
/// learns of its partners by a sparse consensus. Nothing grows with the number of ranks or with
/// the size of the whole grid.
class WindowExchange {
public:
  explicit WindowExchange(const cfd::Mesh& mesh);

  /// Sets this rank's window. The pattern is built for a frame some cells wider, and anew only
  /// when a window of any rank has outgrown its frame or has become much smaller. Collective.
  void bind(const Window& window);

  /// Adds window values to the blocks under them, in order of rank. `from` holds to.size() numbers
  /// for each cell of the window; they go in one message to each owner. Collective.
  void deposit(std::span<const double> from, std::span<cfd::BlockFields* const> to);

  /// Copies block fields to the windows above them, `each` numbers a cell: `from` names as many
  /// fields of each local block, block after block. Collective.
  void sample(std::span<const cfd::Field* const> from, std::size_t each, std::span<double> to);

  /// Numbers that this rank has sent to others so far.
  [[nodiscard]] long numbers_sent() const { return numbers_sent_; }

private:
  /// Part of a frame over one block.
  struct Overlap {
    int block = 0;       ///< index into Mesh::blocks
    cfd::Index3 frame{}; ///< first cell, unwrapped as in the frame
    cfd::Index3 cell{};  ///< first cell, in the block
    cfd::Index3 count{};
  };
  /// What this rank shares with another one, in an order both of them know.
  struct Partner {
    int rank = 0;
    std::vector<Overlap> overlaps;
    std::size_t cells = 0;
    std::vector<double> buffer;
  };

  [[nodiscard]] Window frame_around(const Window& window) const;
  [[nodiscard]] std::vector<Overlap> overlaps_of_lattice() const;
  [[nodiscard]] std::vector<Overlap> overlaps_of_stack() const;
  [[nodiscard]] std::vector<Partner> find_owners() const;
  [[nodiscard]] std::vector<Partner> find_users() const;
  /// Calls row(local block, position in it, cell of the frame, length) for every run of
  /// i-neighbours shared with a partner, in the order both sides know. The block counts for users
  /// only (-1 where an owner's is not local), the cell of the frame for owners only.
  template <class Row> void rows(const Partner& partner, Row&& row) const;
  /// The part of a row that lies in the window: first position in a window field, in the row, and
  /// length.
  struct Inside {
    std::size_t in_window = 0, in_row = 0, length = 0;
  };
  [[nodiscard]] Inside inside(const cfd::Index3& first, std::size_t length) const;

  const cfd::Mesh& mesh_;
  BlockStack stack_;       ///< numbers the cells where the mesh is no lattice
  std::vector<int> local_; ///< of every block: index into Mesh::local, -1 elsewhere
  Window window_;          ///< order of the fields
  Window frame_;           ///< what the pattern is for
  bool bound_ = false;
  std::vector<Partner> owners_; ///< of blocks under this rank's window, by rank
  std::vector<Partner> users_;  ///< whose windows lie over this rank's blocks, by rank
  long numbers_sent_ = 0;
};

} // namespace granflux::coupling
