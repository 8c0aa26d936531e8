// SPDX-FileCopyrightText: 2026 The GranFlux developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include <granflux/coupling/counting_sort.hpp>

namespace granflux::coupling {

/// Numbered items in the order of their cells, those of one cell by number; items in no cell are
/// not listed. Between two coupling steps few items change cells: the order is kept then, and
/// mended where they do. It is the same however it came about, for any number of threads.
class CellOrder {
public:
  static constexpr std::uint32_t nowhere = ~std::uint32_t{0}; ///< for a cell: in none
  /// An item that has gone from one cell to another.
  struct Move {
    std::uint32_t item, from, to;
  };

  /// All anew. items(t, n, visit) calls visit(cell, item) for each item in a cell below `cells`, in
  /// increasing order over the threads t of n; it is called twice.
  template <class Items> void sort(std::size_t cells, Items&& items);
  /// Each item moves at most once; `moves` may be in any order. False where so many have moved that
  /// a sort is quicker: nothing is done then.
  [[nodiscard]] bool mend(std::span<const std::vector<Move>> moves);

  /// Places in the order of the items of a cell.
  [[nodiscard]] std::size_t begin(std::size_t cell) const { return begin_[cell]; }
  [[nodiscard]] std::size_t end(std::size_t cell) const { return begin_[cell + 1]; }
  [[nodiscard]] std::span<const std::uint32_t> items() const { return item_; }

private:
  /// Of an item that leaves a cell or comes to one.
  struct End {
    std::uint32_t cell = 0, item = 0;
    std::size_t place = 0; ///< in the order before: its own, or that of what it comes before
  };

  void find_places(std::vector<End>& ends) const;
  void mend_items(std::size_t first, std::size_t last);
  void mend_begins(std::size_t first, std::size_t last);

  std::vector<std::size_t> begin_{0}; ///< by cell, and the end
  std::vector<std::uint32_t> item_;   ///< by place
  // Kept, so that memory is allocated once.
  CountingSort counting_;
  std::vector<End> leaving_, coming_; ///< by place
  std::vector<std::uint32_t> mended_;
};

template <class Items> void CellOrder::sort(std::size_t cells, Items&& items) {
  counting_.sort(
      cells, items, [&](std::size_t listed) { item_.resize(listed); },
      [&](std::uint32_t item, std::size_t, std::size_t place) { item_[place] = item; });
  begin_ = counting_.begins();
}

} // namespace granflux::coupling
