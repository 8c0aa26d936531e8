// SPDX-FileCopyrightText: 2026 The GranFlux developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <bit>
#include <cstdint>

namespace granflux::coupling {

/// x^(1/3) of a number that is 0 or positive and normal, to the last digit or two, in plain
/// arithmetic without divisions that runs on vector registers, which std::cbrt does not. 0 of
/// negative numbers.
[[nodiscard]] inline double cube_root(double x) {
  // x^(-1/3) by a third of the exponent, from the upper half of the bits: within 4 %. The integer
  // is taken as the last digits of 2^52 + upper, for vector registers multiply no integers of 64
  // bits.
  const std::uint64_t upper = std::bit_cast<std::uint64_t>(x) >> 32;
  constexpr double large = 0x1p52, bias = 0x553ee000;
  const double counted = std::bit_cast<double>(upper | std::bit_cast<std::uint64_t>(large)) - large;
  const double less = (large + bias) - counted * (1. / 3);
  double inverse = std::bit_cast<double>(std::bit_cast<std::uint64_t>(less) << 32);
  // The series of (1 - h)^(-1/3), h = 1 - x inverse^3: each step has four times as many digits.
  for (int step = 0; step < 2; ++step) {
    const double h = 1 - x * inverse * inverse * inverse;
    inverse += inverse * (h * (1. / 3 + h * (2. / 9 + h * (14. / 81))));
  }
  return x > 0 ? x * inverse * inverse : 0;
}

} // namespace granflux::coupling
