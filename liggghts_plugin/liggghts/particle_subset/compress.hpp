// SPDX-FileCopyrightText: 2026 The GranFlux developers
// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

#ifdef __AVX512VL__
#include <bit>

#include <immintrin.h>
#endif

namespace granflux::particle_subset {

/// Writes those of eight numbers whose flag is 1, not 0, one after the other to `to`, of which all
/// eight places may be overwritten, and returns how many there are. No compiler finds the machine's
/// instruction for this by itself; without it the numbers follow each other one by one.
inline int compress(const int* from, const int (&flags)[8], int* to) {
#ifdef __AVX512VL__
  const __m256i flag = _mm256_loadu_si256(reinterpret_cast<const __m256i*>(flags));
  const __m256i numbers = _mm256_loadu_si256(reinterpret_cast<const __m256i*>(from));
  const __mmask8 chosen = _mm256_test_epi32_mask(flag, flag);
  _mm256_storeu_si256(reinterpret_cast<__m256i*>(to), _mm256_maskz_compress_epi32(chosen, numbers));
  return std::popcount(chosen);
#else
  int count = 0;
  for (int l = 0; l < 8; ++l) {
    to[count] = from[l]; // overwritten by the next unless it is one
    count += flags[l];
  }
  return count;
#endif
}

} // namespace granflux::particle_subset
