// SPDX-FileCopyrightText: 2026 The GranFlux developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <vector>

#include <granflux/cfd/mesh.hpp>
#include <granflux/cfd/state_record.hpp>

namespace granflux::cfd {

/// Brings fields of all ranks' blocks to the grid as it was given and back, through rank 0 and one
/// block of that grid at a time. Ghost cells beyond its sides come along, each from the block whose
/// cell is next to it; those between blocks are cells of the given grid. On the same blocks a field
/// comes back to the last bit.
class StateExchange {
public:
  explicit StateExchange(const Mesh& mesh);

  /// Of one field in a record; the same on all ranks.
  [[nodiscard]] std::uint64_t numbers() const;

  /// One field, of each local block. `out` and `in` are of rank 0, null elsewhere. Collective.
  void gather(const std::vector<const Field*>& field, RecordWriter* out) const;
  void scatter(RecordReader* in, const std::vector<Field*>& field) const;

private:
  const Mesh& mesh_;
  int rank_ = 0;
  std::vector<std::vector<int>> blocks_of_; ///< for each block of the given grid
};

} // namespace granflux::cfd
