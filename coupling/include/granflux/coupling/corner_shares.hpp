// SPDX-FileCopyrightText: 2026 The GranFlux developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <type_traits>
#include <vector>

#include <granflux/coupling/counting_sort.hpp>
#include <granflux/coupling/kernel/trilinear.hpp>
#include <granflux/coupling/placing.hpp>

namespace granflux::coupling {

/// Shares of particles in the 2 x 2 x 2 cells around them, as Trilinear has them: of each particle
/// only the lowest of its cells and the shares of the upper ones along x, y, z are kept, in the
/// order of the cells; the eight products are made where they are needed. 32 bytes a particle,
/// where lists of cells and shares take 200.
class CornerShares {
public:
  /// `placed`[p] is set to whether p is coupled and inside the grid.
  Placing build(const Trilinear& kernel, const LatticeLocator& lattice,
                const ParticlesToPlace& particles, std::span<std::uint8_t> placed);

  /// As in Weights. T consists of doubles.
  template <class T> void deposit(std::span<const T> value, std::span<T> field) const;
  template <class T> void sample(std::span<const T> field, std::span<T> value) const;

private:
  /// Particles of one cell lie apart in memory: what is known to be needed soon is fetched ahead.
  static constexpr std::size_t ahead = 24;
  using Eight = std::array<double, 8>;
  [[nodiscard]] static Eight weights(const Vec3& upper) {
    const Vec3 lower{1 - upper.x, 1 - upper.y, 1 - upper.z};
    const double a = lower.y * lower.z, b = upper.y * lower.z;
    const double c = lower.y * upper.z, d = upper.y * upper.z;
    return {lower.x * a, upper.x * a, lower.x * b, upper.x * b,
            lower.x * c, upper.x * c, lower.x * d, upper.x * d};
  }
  template <std::size_t numbers>
  void deposit_row(std::size_t begin, std::size_t end, const double* value, double* field) const;

  Window window_;
  std::array<std::size_t, 8> corner_{}; ///< of the lowest cell's index, in the order of weights()
  CountingSort cells_;                  ///< particles by their lowest cell
  // In that order:
  std::vector<std::uint32_t> particle_, lowest_;
  std::vector<Vec3> upper_;
  bool all_placed_ = true;
  std::vector<TrilinearCorners> of_particle_; ///< kept, so that it is allocated once
};

// The eight cells of a particle belong to two rows of cells along x on two levels: rows and levels
// of the same parity are dealt with by threads side by side, the four parities one after the other.
// A cell is thus added to in an order that does not depend on the threads.
template <class T> void CornerShares::deposit(std::span<const T> value, std::span<T> field) const {
  static_assert(std::is_trivially_copyable_v<T> && sizeof(T) % sizeof(double) == 0);
  constexpr std::size_t numbers = sizeof(T) / sizeof(double);
  const auto* from = reinterpret_cast<const double*>(value.data());
  auto* to = reinterpret_cast<double*>(field.data());
  const auto n = window_.extent();
  const std::size_t row = std::size_t(n[0]);
#pragma omp parallel
  {
#pragma omp for schedule(static)
    for (std::size_t c = 0; c < field.size(); ++c)
      field[c] = T{};
    for (int parity = 0; parity < 4; ++parity) {
#pragma omp for collapse(2) schedule(dynamic, 4)
      for (int k = parity / 2; k < n[2]; k += 2)
        for (int j = parity % 2; j < n[1]; j += 2) {
          const std::size_t begin = row * std::size_t(j + n[1] * k);
          deposit_row<numbers>(begin, begin + row, from, to);
        }
    }
  }
}

template <std::size_t numbers>
void CornerShares::deposit_row(std::size_t begin, std::size_t end, const double* value,
                               double* field) const {
  for (std::size_t cell = begin; cell < end; ++cell) {
    const std::size_t first = cells_.begin(cell), last = cells_.end(cell);
    if (first == last)
      continue;
    double sum[numbers][8] = {};
    for (std::size_t s = first; s < last; ++s) {
      if (s + ahead < particle_.size())
        __builtin_prefetch(value + numbers * particle_[s + ahead]);
      const Eight share = weights(upper_[s]);
      const double* const q = value + numbers * particle_[s];
      for (std::size_t v = 0; v < numbers; ++v)
        for (std::size_t c = 0; c < 8; ++c)
          sum[v][c] += share[c] * q[v];
    }
    for (std::size_t c = 0; c < 8; ++c)
      for (std::size_t v = 0; v < numbers; ++v)
        field[numbers * (cell + corner_[c]) + v] += sum[v][c];
  }
}

template <class T> void CornerShares::sample(std::span<const T> field, std::span<T> value) const {
  static_assert(std::is_trivially_copyable_v<T> && sizeof(T) % sizeof(double) == 0);
  constexpr std::size_t numbers = sizeof(T) / sizeof(double);
  const auto* from = reinterpret_cast<const double*>(field.data());
  auto* to = reinterpret_cast<double*>(value.data());
  if (!all_placed_)
    std::fill(value.begin(), value.end(), T{});
#pragma omp parallel for schedule(static)
  for (std::size_t s = 0; s < particle_.size(); ++s) {
    if (s + ahead < particle_.size())
      __builtin_prefetch(to + numbers * particle_[s + ahead], 1);
    const Eight share = weights(upper_[s]);
    std::array<double, numbers> sum{};
    for (std::size_t c = 0; c < 8; ++c) {
      const double* const q = from + numbers * (lowest_[s] + corner_[c]);
      for (std::size_t v = 0; v < numbers; ++v)
        sum[v] += share[c] * q[v];
    }
    for (std::size_t v = 0; v < numbers; ++v)
      to[numbers * particle_[s] + v] = sum[v];
  }
}

} // namespace granflux::coupling
