// SPDX-FileCopyrightText: 2026 The GranFlux developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <vector>

#include <granflux/cfd/mesh.hpp>

namespace granflux::coupling {

/// Cells of a mesh that is no lattice, numbered as if its blocks lay on top of each other: cell
/// (i, j, k) of a block is (i, j, first(block) + k). So they have windows as those of a lattice.
class BlockStack {
public:
  explicit BlockStack(const std::vector<cfd::BlockInfo>& blocks) : first_(1, 0) {
    for (const cfd::BlockInfo& block : blocks) {
      extent_[0] = std::max(extent_[0], block.cells[0]);
      extent_[1] = std::max(extent_[1], block.cells[1]);
      extent_[2] += block.cells[2];
      first_.push_back(extent_[2]);
    }
  }
  /// First layer of a block; of the number of blocks: the end of the last one.
  [[nodiscard]] int first(int block) const { return first_[std::size_t(block)]; }
  /// Layers, and the largest block's cells in each.
  [[nodiscard]] const cfd::Index3& extent() const { return extent_; }

private:
  std::vector<int> first_;
  cfd::Index3 extent_{};
};

} // namespace granflux::coupling
