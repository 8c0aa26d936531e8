// SPDX-FileCopyrightText: 2026 The GranFlux developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include <granflux/cfd/field.hpp>
#include <granflux/cfd/team.hpp>

namespace granflux::cfd {

/// body(c) for the position c of every interior cell; rows are dealt to the threads.
template <class Body> void for_cells(const Layout& layout, Body&& body) {
  const auto [ni, nj, nk] = layout.cells;
  deal(worth_a_team(layout), nj, nk, [&, ni = ni](int j, int k) {
    const std::ptrdiff_t row = layout.at(0, j, k);
    for (std::ptrdiff_t c = row; c < row + ni; ++c)
      body(c);
  });
}

/// body(f) for every face normal to `direction`, those on the block's sides included; f is the
/// position of the cell above the face.
template <class Body> void for_faces(const Layout& layout, int direction, Body&& body) {
  Index3 n = layout.cells;
  ++n[std::size_t(direction)];
  deal(worth_a_team(layout), n[1], n[2], [&](int j, int k) {
    const std::ptrdiff_t row = layout.at(0, j, k);
    for (std::ptrdiff_t f = row; f < row + n[0]; ++f)
      body(f);
  });
}

/// Sum of term(c) over the interior cells: row by row, then over rows in order, so that the bits
/// do not depend on the number of threads.
template <class Term> double sum_cells(const Layout& layout, Term&& term) {
  const auto [ni, nj, nk] = layout.cells;
  std::vector<double> rows(std::size_t(nj) * std::size_t(nk));
  deal(worth_a_team(layout), nj, nk, [&, ni = ni, nj = nj](int j, int k) {
    const std::ptrdiff_t row = layout.at(0, j, k);
    double sum = 0;
    for (std::ptrdiff_t c = row; c < row + ni; ++c)
      sum += term(c);
    rows[std::size_t(j) + std::size_t(nj) * std::size_t(k)] = sum;
  });
  double total = 0;
  for (double row : rows)
    total += row;
  return total;
}

/// Largest term(c) over the interior cells, or `least`; not-a-number is passed on.
template <class Term> double max_cells(const Layout& layout, double least, Term&& term) {
  const auto [ni, nj, nk] = layout.cells;
  std::vector<double> rows(std::size_t(nj) * std::size_t(nk));
  deal(worth_a_team(layout), nj, nk, [&, ni = ni, nj = nj](int j, int k) {
    const std::ptrdiff_t row = layout.at(0, j, k);
    double largest = least;
    for (std::ptrdiff_t c = row; c < row + ni; ++c) {
      const double value = term(c);
      if (!(value <= largest)) // also true for not-a-number
        largest = value;
    }
    rows[std::size_t(j) + std::size_t(nj) * std::size_t(k)] = largest;
  });
  double largest = least;
  for (double row : rows)
    if (!(row <= largest))
      largest = row;
  return largest;
}

} // namespace granflux::cfd
