// SPDX-FileCopyrightText: 2026 The GranFlux developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <bit>
#include <cstdint>
#include <limits>
#include <numbers>

namespace granflux::coupling {

// Powers in plain arithmetic, without branches and tables: loops over particles run on vector
// registers with them, which they do not with std::pow.

/// Logarithm to the base 2 of a positive normal number, to the last digit or two; minus infinity of
/// 0, not a number of negative ones.
[[nodiscard]] inline double logarithm2(double x) {
  constexpr double infinite = std::numeric_limits<double>::infinity();
  // x = m 2^e with m from sqrt(1/2) to sqrt(2).
  constexpr auto one = std::bit_cast<std::uint64_t>(1.),
                 low = std::bit_cast<std::uint64_t>(std::numbers::sqrt2 / 2);
  const std::uint64_t bits = std::bit_cast<std::uint64_t>(x);
  const std::uint64_t biased = (bits + (one - low)) >> 52;
  const double m = std::bit_cast<double>(bits - (biased << 52) + one);
  // A small integer as the last digits of 2^52, for older vector registers convert none of 64 bits.
  constexpr double large = 0x1p52, bias = 1023;
  const double e =
      std::bit_cast<double>(biased | std::bit_cast<std::uint64_t>(large)) - (large + bias);
  // ln m = 2 artanh s = 2 (s + s^3/3 + s^5/5 + ...), |s| < 0.172
  const double s = (m - 1) / (m + 1), z = s * s;
  double series = 1. / 21;
#pragma GCC unroll 10
  for (int n = 19; n > 0; n -= 2)
    series = series * z + 1. / n;
  const double found = e + 2 / std::numbers::ln2 * s * series;
  const double positive = x < infinite ? found : x;
  return x > 0 ? positive : x == 0 ? -infinite : std::numeric_limits<double>::quiet_NaN();
}

/// 2^x, to the last digit or two; 0 below 2^-1021.
[[nodiscard]] inline double exponential2(double x) {
  // x = k + f with |f| <= 1/2; k stands in the last digits of 1.5 2^52 + k.
  constexpr double large = 0x1.8p52;
  const double shifted = x + large;
  const double f = (x - (shifted - large)) * std::numbers::ln2;
  // exp f = 1 + f (1 + f/2 (1 + f/3 (...)))
  double series = 1;
#pragma GCC unroll 13
  for (int n = 13; n > 0; --n)
    series = 1 + f * series * (1. / n);
  const double found = std::bit_cast<double>(std::bit_cast<std::uint64_t>(series) +
                                             (std::bit_cast<std::uint64_t>(shifted) << 52));
  const double finite = x < 1023 ? found : std::numeric_limits<double>::infinity();
  const double number = x > -1021 ? finite : 0;
  return x == x ? number : x;
}

/// x^y for x >= 0 and y other than 0, to 1e-14 of it where it lies between 1e-14 and 1e14.
[[nodiscard]] inline double power(double x, double y) {
  return exponential2(y * logarithm2(x));
}

} // namespace granflux::coupling
