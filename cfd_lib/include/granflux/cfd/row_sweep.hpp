// SPDX-FileCopyrightText: 2026 The GranFlux developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <vector>

#include <granflux/cfd/sweep.hpp>

namespace granflux::cfd {

/// body(row, j, k) for every row of interior cells along i, row the position of its first; rows
/// are dealt to the threads.
template <class Body> void for_rows(const Layout& layout, Body&& body) {
  const int nj = layout.cells[1], nk = layout.cells[2];
#pragma omp parallel for collapse(2)                                                               \
    schedule(static) if (layout.interior() >= smallest_parallel_sweep)
  for (int k = 0; k < nk; ++k)
    for (int j = 0; j < nj; ++j)
      body(layout.at(0, j, k), j, k);
}

/// Sum of term(row) over the rows, in their order whatever the number of threads; `sums` is work
/// space that is kept by the caller, so that nothing is allocated in a loop.
template <class Term>
double sum_rows(const Layout& layout, std::vector<double>& sums, Term&& term) {
  const auto nj = std::size_t(layout.cells[1]);
  sums.resize(std::max(sums.size(), nj * std::size_t(layout.cells[2])));
  for_rows(layout, [&](std::ptrdiff_t row, int j, int k) {
    sums[std::size_t(j) + nj * std::size_t(k)] = term(row);
  });
  double total = 0;
  for (std::size_t r = 0; r < nj * std::size_t(layout.cells[2]); ++r)
    total += sums[r];
  return total;
}

} // namespace granflux::cfd
