// SPDX-FileCopyrightText: 2026 The GranFlux developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include <granflux/coupling/counting_sort.hpp>

namespace granflux::coupling {

/// Particles in the order of their cells, those of one cell in their own order. Between two
/// coupling steps few particles change cells: the order is kept then, and mended where they do.
/// It is the same however it came about, for any number of threads.
class CellOrder {
public:
  /// cell[p] < `cells`, or `cells` for a particle that is in none.
  void renew(std::size_t cells, std::span<const std::uint32_t> cell);

  /// Places in the order of the particles of a cell.
  [[nodiscard]] std::size_t begin(std::size_t cell) const { return begin_[cell]; }
  [[nodiscard]] std::size_t end(std::size_t cell) const { return begin_[cell + 1]; }
  /// In that order, the ones in no cell last.
  [[nodiscard]] std::span<const std::uint32_t> particles() const { return particle_; }

private:
  /// Of a particle that leaves a cell or comes to one.
  struct Move {
    std::uint32_t cell = 0, particle = 0;
    std::size_t place = 0; ///< in the order before: its own, or that of what it comes before
  };

  void sort(std::size_t cells);
  [[nodiscard]] std::size_t find_moved(std::span<const std::uint32_t> cell);
  void mend(std::span<const std::uint32_t> cell);
  void find_places(std::vector<Move>& moves) const;
  void mend_particles(std::size_t first, std::size_t last);
  void mend_begins(std::size_t first, std::size_t last);

  std::vector<std::size_t> begin_;      ///< by cell, one more for no cell, and the end
  std::vector<std::uint32_t> particle_; ///< by place
  std::vector<std::uint32_t> cell_;     ///< by particle
  // Kept, so that memory is allocated once.
  CountingSort counting_;
  std::vector<std::vector<std::uint32_t>> moved_; ///< particles, [thread]
  std::vector<Move> leaving_, coming_;            ///< by place
  std::vector<std::uint32_t> mended_;
};

} // namespace granflux::coupling
