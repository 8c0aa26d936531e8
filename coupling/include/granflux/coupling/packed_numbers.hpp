// SPDX-FileCopyrightText: 2026 The GranFlux developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstring>
#include <type_traits>

namespace granflux::coupling {

/// N numbers that go through the same sums side by side, on vector registers: as many fours as
/// there are, then a pair, then one. 0 when made.
template <std::size_t N> class PackedNumbers {
public:
  void load(const double* from) {
    std::memcpy(&first_, from, sizeof first_);
    if constexpr (more > 0)
      others_.load(from + width);
  }
  void store(double* to) const {
    std::memcpy(to, &first_, sizeof first_);
    if constexpr (more > 0)
      others_.store(to + width);
  }
  /// As `a` times `factor`.
  void set(const PackedNumbers& a, double factor) {
    first_ = a.first_ * factor;
    if constexpr (more > 0)
      others_.set(a.others_, factor);
  }
  void add(const PackedNumbers& a) {
    first_ += a.first_;
    if constexpr (more > 0)
      others_.add(a.others_);
  }
  void add(const PackedNumbers& a, double factor) {
    first_ += a.first_ * factor;
    if constexpr (more > 0)
      others_.add(a.others_, factor);
  }

private:
  static constexpr std::size_t width = N >= 4 ? 4 : N >= 2 ? 2 : 1, more = N - width;
  struct Nothing {};
  using Pair [[gnu::vector_size(2 * sizeof(double))]] = double;
  using Four [[gnu::vector_size(4 * sizeof(double))]] = double;
  std::conditional_t<width == 4, Four, std::conditional_t<width == 2, Pair, double>> first_{};
  static_assert(sizeof first_ == width * sizeof(double));
  [[no_unique_address]] std::conditional_t<(more > 0), PackedNumbers<more>, Nothing> others_;
};
template <> class PackedNumbers<0>;

} // namespace granflux::coupling
