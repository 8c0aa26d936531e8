// SPDX-FileCopyrightText: 2026 The GranFlux developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <functional>
#include <initializer_list>
#include <vector>

#include <granflux/cfd/mesh.hpp>

namespace granflux::cfd {

/// Fills ghost cells behind links from the cells they stand for, on this rank or another.
/// Built once per mesh; copies and messages follow from precomputed index lists, so the
/// orientation of a link costs nothing.
class Halo {
public:
  /// For the `layers` ghost layers next to the block's sides.
  explicit Halo(const Mesh& mesh, int layers = ghost_layers);

  /// Position of a cell of a local block (index into Mesh::local) in fields of another layout.
  using Position = std::function<std::ptrdiff_t(std::size_t block, const Index3& cell)>;
  Halo(const Mesh& mesh, int layers, const Position& position);

  /// Exchanges the ghost layers of the given fields (each on all local blocks) in one message
  /// per neighbouring rank. Collective.
  void exchange(std::initializer_list<BlockFields*> fields) const;
  void exchange(BlockVectors& vectors) const;
  /// One field in single precision; blocks[b] is the memory of local block b. Collective.
  void exchange(const std::vector<float*>& blocks) const;

private:
  struct Copy {
    int from_block, to_block; ///< indices into Mesh::local
    std::ptrdiff_t from, to;
  };
  struct Message {
    int rank = 0;
    std::vector<std::pair<int, std::ptrdiff_t>> cells; ///< local block and position
    mutable std::vector<std::byte> values; ///< kept, so that an exchange allocates nothing
  };
  template <class Value, class At> void exchange_values(int count, At&& at) const;

  MPI_Comm comm_;
  std::vector<Copy> copies_;
  std::vector<Message> sends_, receives_;
  mutable std::vector<MPI_Request> requests_;
};

} // namespace granflux::cfd
