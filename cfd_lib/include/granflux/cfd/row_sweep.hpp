// SPDX-FileCopyrightText: 2026 The GranFlux developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <array>
#include <vector>

#include <granflux/cfd/sweep.hpp>

namespace granflux::cfd {

/// body(row, j, k) for every row of interior cells along i, row the position of its first (Layout
/// or LevelLayout); rows are dealt to the threads.
template <class AnyLayout, class Body> void for_rows(const AnyLayout& layout, Body&& body) {
  deal(worth_a_team(layout), layout.cells[1], layout.cells[2],
       [&](int j, int k) { body(layout.at(0, j, k), j, k); });
}

/// body(d, row, n) for every row along i of the n faces of each direction d that begin at `row`,
/// those on the block's sides included; the directions of a row follow each other, so that what
/// they share stays in cache.
template <class Body> void for_face_rows(const Layout& layout, Body&& body) {
  const auto [ni, nj, nk] = layout.cells;
  deal(worth_a_team(layout), nj + 1, nk + 1, [&, ni = ni, nj = nj, nk = nk](int j, int k) {
    const std::ptrdiff_t row = layout.at(0, j, k);
    if (j < nj && k < nk)
      body(std::size_t(0), row, ni + 1);
    if (k < nk)
      body(std::size_t(1), row, ni);
    if (j < nj)
      body(std::size_t(2), row, ni);
  });
}

/// Sums of what term(row, j, k) returns, an array of numbers, over the rows in their order whatever
/// the number of threads; `room` is work space that is kept by the caller, so that nothing is
/// allocated in a loop.
template <std::size_t count, class Term>
std::array<double, count> sum_rows(const Layout& layout, std::vector<double>& room, Term&& term) {
  const auto nj = std::size_t(layout.cells[1]), rows = nj * std::size_t(layout.cells[2]);
  room.resize(std::max(room.size(), count * rows));
  for_rows(layout, [&](std::ptrdiff_t row, int j, int k) {
    const std::array<double, count> sums = term(row, j, k);
    std::copy(sums.begin(), sums.end(), &room[count * (std::size_t(j) + nj * std::size_t(k))]);
  });
  std::array<double, count> total{};
  for (std::size_t r = 0; r < rows; ++r)
    for (std::size_t n = 0; n < count; ++n)
      total[n] += room[count * r + n];
  return total;
}

} // namespace granflux::cfd
