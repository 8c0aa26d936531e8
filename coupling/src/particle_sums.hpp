// SPDX-FileCopyrightText: 2026 The GranFlux developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <cstddef>
#include <omp.h>
#include <vector>

#include <granflux/coupling/particle_block.hpp>

namespace granflux::coupling {

/// Sums add(p, sums) over 0 <= p < n, each thread a fixed part, in order of thread.
template <class Sums, class Add> Sums sum_particles(std::size_t n, Add&& add) {
  std::vector<Sums> parts(static_cast<std::size_t>(omp_get_max_threads()));
#pragma omp parallel
  {
    Sums mine;
#pragma omp for schedule(static)
    for (std::ptrdiff_t p = 0; p < std::ptrdiff_t(n); ++p)
      add(std::size_t(p), mine);
    parts[std::size_t(omp_get_thread_num())] = mine;
  }
  Sums total;
  for (const Sums& part : parts)
    total += part;
  return total;
}

/// The same of add(first, count, sums) for blocks of particles.
template <class Sums, class Add> Sums sum_blocks(std::size_t n, Add&& add) {
  const std::size_t blocks = (n + particles_a_block - 1) / particles_a_block;
  return sum_particles<Sums>(blocks, [&](std::size_t b, Sums& sums) {
    const std::size_t first = b * particles_a_block;
    add(first, std::min(particles_a_block, n - first), sums);
  });
}

} // namespace granflux::coupling
