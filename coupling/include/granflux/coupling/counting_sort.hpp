// SPDX-FileCopyrightText: 2026 The GranFlux developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <omp.h>
#include <utility>
#include <vector>

namespace granflux::coupling {

/// Stable sort of items into bins by all threads, the same for any number of them. Keeps its
/// memory from sort to sort.
class CountingSort {
public:
  /// items(t, n, visit) calls visit(bin, item) for each item of the run of thread t of n, in order;
  /// it is called twice. make_room(count) is told how many there are, then put(item, bin, place)
  /// where each item goes.
  template <class Items, class MakeRoom, class Put>
  void sort(std::size_t bins, Items&& items, MakeRoom&& make_room, Put&& put);

  /// First place of a bin; that of bin + 1 is its end.
  [[nodiscard]] std::size_t begin(std::size_t bin) const { return begin_[bin]; }
  [[nodiscard]] std::size_t end(std::size_t bin) const { return begin_[bin + 1]; }
  [[nodiscard]] const std::vector<std::size_t>& begins() const { return begin_; }

private:
  std::vector<std::size_t> begin_{0};
  std::vector<std::vector<std::uint32_t>> tally_; ///< [thread][bin]
};

// Every thread counts the items of its own run; a running sum over bins, and within a bin over
// threads, then says where each thread puts them.
template <class Items, class MakeRoom, class Put>
void CountingSort::sort(std::size_t bins, Items&& items, MakeRoom&& make_room, Put&& put) {
  begin_.resize(bins + 1);
  begin_[0] = 0;
#pragma omp parallel
  {
    const int t = omp_get_thread_num(), n = omp_get_num_threads();
#pragma omp single
    tally_.resize(std::size_t(n));
    auto& mine = tally_[std::size_t(t)];
    mine.assign(bins, 0);
    items(t, n, [&](std::size_t bin, const auto&) { ++mine[bin]; });
#pragma omp barrier
#pragma omp for schedule(static)
    for (std::size_t bin = 0; bin < bins; ++bin) {
      std::uint32_t before = 0;
      for (auto& of_thread : tally_)
        before += std::exchange(of_thread[bin], before);
      begin_[bin + 1] = before;
    }
#pragma omp single
    {
      for (std::size_t bin = 0; bin < bins; ++bin)
        begin_[bin + 1] += begin_[bin];
      make_room(begin_[bins]);
    }
    items(t, n,
          [&](std::size_t bin, const auto& item) { put(item, bin, begin_[bin] + mine[bin]++); });
  }
}

} // namespace granflux::coupling
