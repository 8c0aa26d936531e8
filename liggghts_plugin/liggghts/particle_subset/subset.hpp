// SPDX-FileCopyrightText: 2026 The GranFlux developers
// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

#include <algorithm>
#include <cstdint>

namespace granflux::particle_subset {

/// Particles begin ... end - 1.
struct Range {
  int begin = 0, end = 0;
  [[nodiscard]] int size() const { return end - begin; }
  [[nodiscard]] bool holds(int particle) const { return particle >= begin && particle < end; }
};

/// The particles 0 ... count - 1 that a rank owns, divided by number into one contiguous range per
/// thread (Amritkar, Deb, Tafti, J. Comput. Phys. 256 (2014), section 3). A range is compact in
/// space as far as particles are sorted by place (SpatialOrder). Depends on the two numbers alone,
/// so that whoever asks gets the same answer; ranges begin at multiples of `line` particles, so
/// that no two threads write one cache line of an aligned array of doubles or of vectors.
class Subset {
public:
  static constexpr int line = 8;
  /// Particles that several passes go over together: what they touch of so many stays in the
  /// second-level cache.
  static constexpr int block = 2048;

  Subset(int count, int threads) : count_(count), threads_(threads) {}

  [[nodiscard]] Range of(int thread) const { return {begin(thread), begin(thread + 1)}; }
  [[nodiscard]] int count() const { return count_; }
  [[nodiscard]] int threads() const { return threads_; }

  friend bool operator==(const Subset&, const Subset&) = default;

private:
  [[nodiscard]] int begin(int thread) const {
    if (thread >= threads_)
      return count_;
    return int(std::int64_t(count_) * thread / threads_) / line * line;
  }

  int count_, threads_;
};

/// Calls visit(block) for the blocks of a range one after the other.
template <class Visit> void for_each_block(Range range, Visit&& visit) {
  for (int begin = range.begin; begin < range.end; begin += Subset::block)
    visit(Range{begin, std::min(begin + Subset::block, range.end)});
}

} // namespace granflux::particle_subset
