// SPDX-FileCopyrightText: 2026 The GranFlux developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>

#include <omp.h>

namespace granflux::cfd {

/// Blocks of fewer cells are swept by one thread: a fork costs more than their work.
inline constexpr std::ptrdiff_t smallest_parallel_sweep = 4096;

template <class AnyLayout> [[nodiscard]] bool worth_a_team(const AnyLayout& layout) {
  return layout.interior() >= smallest_parallel_sweep;
}

/// body() by each thread of a team, or once, by the calling thread, where that is not worth it:
/// OpenMP's own `if` makes a team of one then, which GNU's library ends with a system call.
template <class Body> void in_team(bool worth_it, Body&& body) {
  if (worth_it && omp_get_max_threads() > 1) {
#pragma omp parallel
    body();
  } else {
    body();
  }
}

/// body(n) for 0 <= n < count, dealt to the threads where that is worth it.
template <class Body> void deal(bool worth_it, std::ptrdiff_t count, Body&& body) {
  in_team(worth_it, [&] {
#pragma omp for schedule(static) nowait
    for (std::ptrdiff_t n = 0; n < count; ++n)
      body(n);
  });
}

/// body(j, k) for 0 <= j < nj and 0 <= k < nk, dealt to the threads where that is worth it.
template <class Body> void deal(bool worth_it, int nj, int nk, Body&& body) {
  in_team(worth_it, [&] {
#pragma omp for collapse(2) schedule(static) nowait
    for (int k = 0; k < nk; ++k)
      for (int j = 0; j < nj; ++j)
        body(j, k);
  });
}

} // namespace granflux::cfd
