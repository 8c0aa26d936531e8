// SPDX-FileCopyrightText: 2026 The GranFlux developers
// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

#ifdef __AVX__
#include <immintrin.h>
#else
#include <cstring>
#endif

#include <granflux/cfd/vec3.hpp>

namespace granflux::particle_subset {

/// Four numbers in one register, or in what a machine without such has in its place. Handed on by
/// reference: how it is passed by value depends on the machine.
using Four = double __attribute__((vector_size(32)));
using FourRows = Four[4];

/// The three numbers at `from`, none behind them, and 0.
inline void take(Four& row, const double* from) {
#ifdef __AVX__
  row = _mm256_maskload_pd(from, _mm256_setr_epi64x(-1, -1, -1, 0));
#else
  using Two = double __attribute__((vector_size(16)));
  Two first;
  std::memcpy(&first, from, sizeof first);
  row = __builtin_shufflevector(first, Two{from[2], 0}, 0, 1, 2, 3);
#endif
}
inline void take(Four& row, const Vec3& vector) {
  take(row, &vector.x);
}

/// Rows become columns.
inline void transpose(FourRows& r) {
  const Four even01 = __builtin_shufflevector(r[0], r[1], 0, 4, 2, 6);
  const Four odd01 = __builtin_shufflevector(r[0], r[1], 1, 5, 3, 7);
  const Four even23 = __builtin_shufflevector(r[2], r[3], 0, 4, 2, 6);
  const Four odd23 = __builtin_shufflevector(r[2], r[3], 1, 5, 3, 7);
  r[0] = __builtin_shufflevector(even01, even23, 0, 1, 4, 5);
  r[1] = __builtin_shufflevector(odd01, odd23, 0, 1, 4, 5);
  r[2] = __builtin_shufflevector(even01, even23, 2, 3, 6, 7);
  r[3] = __builtin_shufflevector(odd01, odd23, 2, 3, 6, 7);
}

} // namespace granflux::particle_subset
