// SPDX-FileCopyrightText: 2026 The GranFlux developers
// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

#include <omp.h>

#include "subset.hpp"

namespace granflux::particle_subset {

/// Work on fewer particles takes less time than to wake a team of threads for it.
constexpr int least_for_team = 1024;

/// Calls work(range) once on every OpenMP thread, with the thread's share of the particles
/// 0 ... count - 1, or once for all of them if they are few. work must write what belongs to its
/// particles only.
template <class Work> void for_each_subset(int count, Work&& work) {
  const Subset subset(count, count < least_for_team ? 1 : omp_get_max_threads());
  if (subset.threads() == 1) {
    work(subset.of(0));
    return;
  }
#pragma omp parallel num_threads(subset.threads())
  work(subset.of(omp_get_thread_num()));
}

} // namespace granflux::particle_subset
