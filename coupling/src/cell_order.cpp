// SPDX-FileCopyrightText: 2026 The GranFlux developers
// SPDX-License-Identifier: BSD-3-Clause
#include <granflux/coupling/cell_order.hpp>

#include <algorithm>
#include <omp.h>
#include <tuple>

#include <granflux/coupling/placing.hpp>

namespace granflux::coupling {

bool CellOrder::mend(std::span<const std::vector<Move>> moves) {
  constexpr std::size_t worth_mending = 16; // at most one item in as many has moved
  std::size_t moved = 0;
  for (const auto& list : moves)
    moved += list.size();
  if (moved == 0)
    return true;
  if (moved > item_.size() / worth_mending)
    return false;
  leaving_.clear();
  coming_.clear();
  for (const auto& list : moves)
    for (const Move& move : list) {
      if (move.from != nowhere)
        leaving_.push_back({.cell = move.from, .item = move.item});
      if (move.to != nowhere)
        coming_.push_back({.cell = move.to, .item = move.item});
    }
  find_places(leaving_);
  find_places(coming_);
  mended_.resize(item_.size() + coming_.size() - leaving_.size());
#pragma omp parallel
  {
    const int t = omp_get_thread_num(), threads = omp_get_num_threads();
    mend_items(run_begin(item_.size(), t, threads), run_begin(item_.size(), t + 1, threads));
    mend_begins(run_begin(begin_.size(), t, threads), run_begin(begin_.size(), t + 1, threads));
  }
  item_.swap(mended_);
  return true;
}

void CellOrder::find_places(std::vector<End>& ends) const {
  std::sort(ends.begin(), ends.end(), [](const End& a, const End& b) {
    return std::tie(a.cell, a.item) < std::tie(b.cell, b.item);
  });
  for (End& at : ends) {
    const auto first = item_.begin() + std::ptrdiff_t(begin(at.cell));
    const auto last = item_.begin() + std::ptrdiff_t(end(at.cell));
    at.place = std::size_t(std::lower_bound(first, last, at.item) - item_.begin());
  }
}

/// Copies the items at first <= place < last without those that leave and with those that come
/// before one of them; whoever has the last place adds those that come after it.
void CellOrder::mend_items(std::size_t first, std::size_t last) {
  if (first == last)
    return;
  const auto next = [](const std::vector<End>& ends, std::size_t place) {
    return std::partition_point(ends.begin(), ends.end(),
                                [&](const End& at) { return at.place < place; });
  };
  auto leaving = next(leaving_, first), coming = next(coming_, first);
  const bool to_the_end = last == item_.size();
  auto to = mended_.begin() + std::ptrdiff_t(first) - (leaving - leaving_.begin()) +
            (coming - coming_.begin());
  for (std::size_t place = first;;) {
    for (; coming != coming_.end() && coming->place == place && (place < last || to_the_end);
         ++coming)
      *to++ = coming->item;
    if (place >= last)
      return;
    if (leaving != leaving_.end() && leaving->place == place) {
      ++leaving;
      ++place;
      continue;
    }
    std::size_t until = last;
    if (leaving != leaving_.end())
      until = std::min(until, leaving->place);
    if (coming != coming_.end())
      until = std::min(until, coming->place);
    to =
        std::copy(item_.begin() + std::ptrdiff_t(place), item_.begin() + std::ptrdiff_t(until), to);
    place = until;
  }
}

void CellOrder::mend_begins(std::size_t first, std::size_t last) {
  const auto below = [](const std::vector<End>& ends, std::size_t cell) {
    return std::partition_point(ends.begin(), ends.end(),
                                [&](const End& at) { return at.cell < cell; });
  };
  auto leaving = below(leaving_, first), coming = below(coming_, first);
  for (std::size_t cell = first; cell < last; ++cell) {
    while (leaving != leaving_.end() && leaving->cell < cell)
      ++leaving;
    while (coming != coming_.end() && coming->cell < cell)
      ++coming;
    begin_[cell] += std::size_t(coming - coming_.begin());
    begin_[cell] -= std::size_t(leaving - leaving_.begin());
  }
}

} // namespace granflux::coupling
