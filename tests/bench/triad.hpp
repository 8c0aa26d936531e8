// SPDX-FileCopyrightText: 2026 The GranFlux developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <chrono>
#include <cstddef>
#include <memory>

namespace granflux::bench {

/// GB/s of a[i] = b[i] + s c[i] by all OpenMP threads, 24 bytes counted an entry (the write's fetch
/// is not). The best of many short rounds by the clock: one of them is not disturbed.
inline double triad() {
  constexpr std::ptrdiff_t n = 4'000'000; // 96 MB: more than caches hold
  constexpr int rounds = 100;
  const auto room = [] { return std::make_unique_for_overwrite<double[]>(n); };
  const auto a = room(), b = room(), c = room();
#pragma omp parallel for simd schedule(static)
  for (std::ptrdiff_t i = 0; i < n; ++i)
    a[i] = 0, b[i] = 1, c[i] = 2;
  double best = 0;
  for (int round = 0; round < rounds; ++round) {
    const double s = 1 + 0.001 * round;
    const auto begin = std::chrono::steady_clock::now();
#pragma omp parallel for simd schedule(static)
    for (std::ptrdiff_t i = 0; i < n; ++i)
      a[i] = b[i] + s * c[i];
    const std::chrono::duration<double> seconds = std::chrono::steady_clock::now() - begin;
    best = std::max(best, 24e-9 * double(n) / seconds.count());
  }
  return best;
}

} // namespace granflux::bench
