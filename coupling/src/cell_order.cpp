// SPDX-FileCopyrightText: 2026 The GranFlux developers
// SPDX-License-Identifier: BSD-3-Clause
#include <granflux/coupling/cell_order.hpp>

#include <algorithm>
#include <omp.h>
#include <tuple>

#include <granflux/coupling/placing.hpp>

namespace granflux::coupling {

void CellOrder::renew(std::size_t cells, std::span<const std::uint32_t> cell) {
  constexpr std::size_t worth_mending = 16; // at most one particle in as many has moved
  if (cell.size() == cell_.size() && begin_.size() == cells + 2) {
    const std::size_t moved = find_moved(cell);
    if (moved <= cell.size() / worth_mending) {
      if (moved > 0)
        mend(cell);
      return;
    }
  }
  cell_.assign(cell.begin(), cell.end());
  sort(cells);
}

void CellOrder::sort(std::size_t cells) {
  const std::size_t count = cell_.size();
  particle_.resize(count);
  counting_.sort(
      cells + 1,
      [&](int t, int threads, auto&& visit) {
        const std::size_t end = run_begin(count, t + 1, threads);
        for (std::size_t p = run_begin(count, t, threads); p < end; ++p)
          visit(cell_[p], p);
      },
      [&](std::size_t p, std::size_t, std::size_t place) { particle_[place] = std::uint32_t(p); });
  begin_ = counting_.begins();
}

std::size_t CellOrder::find_moved(std::span<const std::uint32_t> cell) {
  moved_.resize(std::size_t(omp_get_max_threads()));
  for (auto& of_thread : moved_)
    of_thread.clear();
  std::size_t count = 0;
#pragma omp parallel reduction(+ : count)
  {
    const int t = omp_get_thread_num(), threads = omp_get_num_threads();
    auto& mine = moved_[std::size_t(t)];
    const std::size_t end = run_begin(cell.size(), t + 1, threads);
    for (std::size_t p = run_begin(cell.size(), t, threads); p < end; ++p)
      if (cell[p] != cell_[p]) [[unlikely]]
        mine.push_back(std::uint32_t(p));
    count = mine.size();
  }
  return count;
}

void CellOrder::mend(std::span<const std::uint32_t> cell) {
  leaving_.clear();
  coming_.clear();
  for (const auto& of_thread : moved_)
    for (const std::uint32_t p : of_thread) {
      leaving_.push_back({.cell = cell_[p], .particle = p});
      coming_.push_back({.cell = cell[p], .particle = p});
      cell_[p] = cell[p];
    }
  find_places(leaving_);
  find_places(coming_);
  mended_.resize(particle_.size());
#pragma omp parallel
  {
    const int t = omp_get_thread_num(), threads = omp_get_num_threads();
    mend_particles(run_begin(particle_.size(), t, threads),
                   run_begin(particle_.size(), t + 1, threads));
    mend_begins(run_begin(begin_.size(), t, threads), run_begin(begin_.size(), t + 1, threads));
  }
  particle_.swap(mended_);
}

void CellOrder::find_places(std::vector<Move>& moves) const {
  std::sort(moves.begin(), moves.end(), [](const Move& a, const Move& b) {
    return std::tie(a.cell, a.particle) < std::tie(b.cell, b.particle);
  });
  for (Move& move : moves) {
    const auto first = particle_.begin() + std::ptrdiff_t(begin(move.cell));
    const auto last = particle_.begin() + std::ptrdiff_t(end(move.cell));
    move.place = std::size_t(std::lower_bound(first, last, move.particle) - particle_.begin());
  }
}

/// Copies the particles at first <= place < last without those that leave and with those that come
/// before one of them; whoever has the last place adds those that come after it.
void CellOrder::mend_particles(std::size_t first, std::size_t last) {
  if (first == last)
    return;
  const auto next = [](const std::vector<Move>& moves, std::size_t place) {
    return std::partition_point(moves.begin(), moves.end(),
                                [&](const Move& move) { return move.place < place; });
  };
  auto leaving = next(leaving_, first), coming = next(coming_, first);
  const bool to_the_end = last == particle_.size();
  auto to = mended_.begin() + std::ptrdiff_t(first) - (leaving - leaving_.begin()) +
            (coming - coming_.begin());
  for (std::size_t place = first;;) {
    for (; coming != coming_.end() && coming->place == place && (place < last || to_the_end);
         ++coming)
      *to++ = coming->particle;
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
    to = std::copy(particle_.begin() + std::ptrdiff_t(place),
                   particle_.begin() + std::ptrdiff_t(until), to);
    place = until;
  }
}

void CellOrder::mend_begins(std::size_t first, std::size_t last) {
  const auto below = [](const std::vector<Move>& moves, std::size_t cell) {
    return std::partition_point(moves.begin(), moves.end(),
                                [&](const Move& move) { return move.cell < cell; });
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
