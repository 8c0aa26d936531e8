// SPDX-FileCopyrightText: 2026 The GranFlux developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include <granflux/coupling/kernel/kernels.hpp>
#include <granflux/coupling/window.hpp>

namespace granflux::coupling {

/// Shares of the particles of this rank in the gas cells around them. Depositing and sampling
/// use the same shares, so that one is the adjoint of the other: for particle values q and a
/// window field f
///
///   sum_p q_p sample(f)_p = sum_c deposit(q)_c f_c .
///
/// Both are loops in which each result is summed by one thread in a fixed order: the same bits for
/// every number of threads. Values may be of any type with zero T{}, += and * double.
class Weights {
public:
  /// Renews the shares. Particles whose `coupled` entry is 0 (if given) are left out; so are those
  /// with their centre outside the grid, which are counted. The kernel must serve the locator.
  void build(const AnyKernel& kernel, const AnyLocator& locator, std::span<const Vec3> position,
             std::span<const double> radius, std::span<const std::uint8_t> coupled = {});

  [[nodiscard]] const Window& window() const { return window_; }
  [[nodiscard]] std::size_t particles() const { return offset_.size() - 1; }
  /// Coupled and inside the grid.
  [[nodiscard]] bool placed(std::size_t p) const { return offset_[p] < offset_[p + 1]; }
  [[nodiscard]] std::size_t placed_count() const { return placed_; }
  /// Particles meant to be coupled but outside the grid.
  [[nodiscard]] std::size_t outside_count() const { return outside_; }

  /// Window cells that particle p touches, and its shares in them.
  [[nodiscard]] std::span<const std::uint32_t> cells(std::size_t p) const {
    return {cell_.data() + offset_[p], offset_[p + 1] - offset_[p]};
  }
  [[nodiscard]] std::span<const double> shares(std::size_t p) const {
    return {share_.data() + offset_[p], offset_[p + 1] - offset_[p]};
  }

  /// field[c] = sum over particles of share * value. `field` has window().size() entries.
  template <class T> void deposit(std::span<const T> value, std::span<T> field) const;
  /// value[p] = sum over cells of share * field; T{} for a particle that is not placed.
  template <class T> void sample(std::span<const T> field, std::span<T> value) const;

private:
  /// Shares found by one thread for its run of consecutive particles.
  struct Run {
    struct Entry {
      cfd::Index3 cell;
      double share;
    };
    std::vector<Entry> entries;
    std::size_t placed = 0, outside = 0;
    Window window; ///< tight around its cells
  };

  template <class Kernel, class Locator>
  void find_shares(const Kernel& kernel, const Locator& locator, std::span<const Vec3> position,
                   std::span<const double> radius, std::span<const std::uint8_t> coupled);
  void number_cells();
  void transpose();

  Window window_;
  std::size_t placed_ = 0, outside_ = 0;
  // particle -> cells, by particle
  std::vector<std::size_t> offset_{0};
  std::vector<std::uint32_t> cell_;
  std::vector<double> share_;
  // cell -> particles, each cell's in particle order
  std::vector<std::size_t> cell_offset_{0};
  std::vector<std::uint32_t> particle_;
  std::vector<double> cell_share_;
  // kept from build to build, so that they allocate once
  std::vector<Run> runs_;
  std::vector<std::vector<std::uint32_t>> tally_; ///< [thread][cell]
};

template <class T> void Weights::deposit(std::span<const T> value, std::span<T> field) const {
  const auto cells = std::ptrdiff_t(window_.size());
#pragma omp parallel for schedule(guided)
  for (std::ptrdiff_t c = 0; c < cells; ++c) {
    T sum{};
    for (std::size_t e = cell_offset_[std::size_t(c)]; e < cell_offset_[std::size_t(c) + 1]; ++e)
      sum += value[particle_[e]] * cell_share_[e];
    field[std::size_t(c)] = sum;
  }
}

template <class T> void Weights::sample(std::span<const T> field, std::span<T> value) const {
  const auto count = std::ptrdiff_t(particles());
#pragma omp parallel for schedule(static)
  for (std::ptrdiff_t p = 0; p < count; ++p) {
    T sum{};
    for (std::size_t e = offset_[std::size_t(p)]; e < offset_[std::size_t(p) + 1]; ++e)
      sum += field[cell_[e]] * share_[e];
    value[std::size_t(p)] = sum;
  }
}

} // namespace granflux::coupling
