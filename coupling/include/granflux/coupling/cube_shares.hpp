// SPDX-FileCopyrightText: 2026 The GranFlux developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <type_traits>
#include <vector>

#include <granflux/coupling/cell_order.hpp>
#include <granflux/coupling/kernel/spline_kernel.hpp>
#include <granflux/coupling/packed_numbers.hpp>
#include <granflux/coupling/placing.hpp>

namespace granflux::coupling {

class LinearPlaces;

/// Shares of particles in the n x n x n cells around them, as SplineKernel has them: of each
/// particle only the lowest of its cells and n - 1 shares along x, y, z are kept; the products are
/// made where they are needed. With the order of the particles by cell that is 40 bytes a particle
/// for n = 2 and 64 for n = 3, where lists of cells and shares take 200 and 650.
template <int n> class CubeShares {
public:
  static constexpr std::size_t most_particles = std::size_t{1} << 32;

  /// `placed`[p] is set to whether p is coupled and inside the grid.
  Placing build(const SplineKernel<n>& kernel, const LatticeLocator& lattice,
                const ParticlesToPlace& particles, std::span<std::uint8_t> placed);

  /// As in Weights. T consists of doubles.
  template <class T> void deposit(std::span<const T> value, std::span<T> field) const;
  template <class T> void sample(std::span<const T> field, std::span<T> value) const;

private:
  /// Particles of one cell lie apart in memory: what is known to be needed soon is fetched ahead.
  static constexpr std::size_t ahead = 24;
  static constexpr std::size_t cells = n * n * n;
  using Others = std::array<typename CellRow<n>::Others, 3>;
  template <std::size_t numbers>
  void deposit_row(std::size_t begin, std::size_t end, const double* value, double* field) const;

  static Window find_window(const SplineKernel<n>& kernel, const LatticeLocator& lattice,
                            const ParticlesToPlace& particles);
  using Moves = std::vector<CellOrder::Move>;
  void set_lowest(std::size_t p, std::uint32_t cell, Moves& moves);
  bool place(std::size_t p, const CellCube<n>& cube, const Window& lowest, Moves& moves);
  std::size_t place_together(const std::optional<LinearPlaces>& places, const Vec3* position,
                             std::size_t first, std::size_t count, Moves& moves);
  std::optional<Placing> place_all(const SplineKernel<n>& kernel, const LatticeLocator& lattice,
                                   const ParticlesToPlace& particles,
                                   std::span<std::uint8_t> placed);

  Window window_;
  int builds_left_ = 0;                     ///< for which window_ may be kept
  std::array<std::size_t, cells> offset_{}; ///< from the lowest cell, in the order of products()
  // By particle:
  std::vector<std::uint32_t> lowest_; ///< CellOrder::nowhere where it is not placed
  std::vector<Others> others_;
  CellOrder by_cell_;        ///< particles by their lowest cells
  std::vector<Moves> moves_; ///< since the last build, [thread]
};

// The cells of a particle belong to n rows of cells along x on each of n levels: rows n apart, and
// levels, are dealt with by threads side by side, the n x n sets of them one after the other. A
// cell is thus added to in an order that does not depend on the threads.
template <int n>
template <class T>
void CubeShares<n>::deposit(std::span<const T> value, std::span<T> field) const {
  static_assert(std::is_trivially_copyable_v<T> && sizeof(T) % sizeof(double) == 0);
  constexpr std::size_t numbers = sizeof(T) / sizeof(double);
  const auto* from = reinterpret_cast<const double*>(value.data());
  auto* to = reinterpret_cast<double*>(field.data());
  const auto extent = window_.extent();
  const std::size_t row = std::size_t(extent[0]);
#pragma omp parallel
  {
#pragma omp for schedule(static)
    for (std::size_t c = 0; c < field.size(); ++c)
      field[c] = T{};
    for (int set = 0; set < n * n; ++set) {
#pragma omp for collapse(2) schedule(dynamic, 4)
      for (int k = set / n; k < extent[2]; k += n)
        for (int j = set % n; j < extent[1]; j += n) {
          const std::size_t begin = row * std::size_t(j + extent[1] * k);
          deposit_row<numbers>(begin, begin + row, from, to);
        }
    }
  }
}

template <int n>
template <std::size_t numbers>
void CubeShares<n>::deposit_row(std::size_t begin, std::size_t end, const double* value,
                                double* field) const {
  const std::span<const std::uint32_t> particles = by_cell_.items();
  for (std::size_t cell = begin; cell < end; ++cell) {
    const std::size_t first = by_cell_.begin(cell), last = by_cell_.end(cell);
    if (first == last)
      continue;
    std::array<PackedNumbers<numbers>, cells> sum;
    for (std::size_t s = first; s < last; ++s) {
      if (s + ahead < particles.size()) {
        __builtin_prefetch(&others_[particles[s + ahead]]);
        __builtin_prefetch(value + numbers * particles[s + ahead]);
      }
      const Others& others = others_[particles[s]];
      const auto x = CellRow<n>::all(others[0]), y = CellRow<n>::all(others[1]),
                 z = CellRow<n>::all(others[2]);
      PackedNumbers<numbers> q, of_level, of_row;
      q.load(value + numbers * particles[s]);
      auto cell_sum = sum.begin();
      for (const double share_z : z) {
        of_level.set(q, share_z);
        for (const double share_y : y) {
          of_row.set(of_level, share_y);
          for (const double share_x : x)
            (cell_sum++)->add(of_row, share_x);
        }
      }
    }
    for (std::size_t c = 0; c < cells; ++c) {
      double* const at = field + numbers * (cell + offset_[c]);
      PackedNumbers<numbers> before;
      before.load(at);
      sum[c].add(before);
      sum[c].store(at);
    }
  }
}

template <int n>
template <class T>
void CubeShares<n>::sample(std::span<const T> field, std::span<T> value) const {
  static_assert(std::is_trivially_copyable_v<T> && sizeof(T) % sizeof(double) == 0);
  constexpr std::size_t numbers = sizeof(T) / sizeof(double);
  const auto* from = reinterpret_cast<const double*>(field.data());
  auto* to = reinterpret_cast<double*>(value.data());
  std::array<std::size_t, cells> offset;
  for (std::size_t c = 0; c < cells; ++c)
    offset[c] = numbers * offset_[c];
#pragma omp parallel for schedule(static) firstprivate(offset)
  for (std::size_t p = 0; p < lowest_.size(); ++p) {
    PackedNumbers<numbers> sum, of_level, of_row, of_cell;
    if (lowest_[p] != CellOrder::nowhere) {
      const double* const lowest = from + numbers * lowest_[p];
      const Others& others = others_[p];
      const auto x = CellRow<n>::all(others[0]), y = CellRow<n>::all(others[1]),
                 z = CellRow<n>::all(others[2]);
#pragma GCC unroll 3
      for (std::size_t k = 0; k < n; ++k) {
#pragma GCC unroll 3
        for (std::size_t j = 0; j < n; ++j) {
#pragma GCC unroll 3
          for (std::size_t i = 0; i < n; ++i) {
            of_cell.load(lowest + offset[i + n * (j + n * k)]);
            i == 0 ? of_row.set(of_cell, x[0]) : of_row.add(of_cell, x[i]);
          }
          j == 0 ? of_level.set(of_row, y[0]) : of_level.add(of_row, y[j]);
        }
        k == 0 ? sum.set(of_level, z[0]) : sum.add(of_level, z[k]);
      }
    }
    sum.store(to + numbers * p);
  }
}

} // namespace granflux::coupling
