// SPDX-FileCopyrightText: 2026 The GranFlux developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <omp.h>
#include <optional>
#include <span>
#include <string_view>
#include <type_traits>
#include <vector>

#include <granflux/coupling/cell_order.hpp>
#include <granflux/coupling/kernel/kernels.hpp>
#include <granflux/coupling/placing.hpp>

namespace granflux::coupling {

/// Shares of particles in any cells, as numbers of equal parts: of each particle its entries, one a
/// cell, and the entries in the order of their cells. From build to build all are kept but those of
/// particles that have gone too far for their shares.
class ShareLists {
public:
  static constexpr std::size_t most_particles = std::size_t{1} << 27;

  /// `placed`[p] is set to whether p is coupled and inside the grid.
  template <class Kernel, class Locator>
  Placing build(const Kernel& kernel, const Locator& locator, const ParticlesToPlace& particles,
                std::span<std::uint8_t> placed);

  /// As in Weights. T consists of doubles.
  template <class T> void deposit(std::span<const T> value, std::span<T> field) const;
  template <class T> void sample(std::span<const T> field, std::span<T> value) const;

private:
  static constexpr unsigned row_bits = 5;
  static_assert(1u << row_bits >= most_cells_of_a_particle);
  static_assert(most_particles << row_bits == std::size_t{1} << 32);
  /// Number of the k-th entry of particle p in by_cell_.
  static std::uint32_t item(std::size_t p, std::size_t k) {
    return std::uint32_t(p << row_bits | k);
  }

  /// The place for which the shares of a particle were found. They are kept while it is near.
  struct Found {
    Vec3 centre;
    double radius = 0;
    Room room;
    [[nodiscard]] bool serves(const Vec3& x, double r) const {
      return (r == radius) & room.holds(x - centre);
    }
  };
  /// What a kernel says of one particle.
  struct Entries {
    std::array<cfd::Index3, most_cells_of_a_particle> cell;
    std::array<std::uint8_t, most_cells_of_a_particle> parts;
    std::size_t count = 0;
  };
  /// What one thread, or all, have met.
  struct Pass {
    Placing placing;
    std::size_t most_entries = 0;
    bool fits = true; ///< all entries have a place in the window and in the rows
    Pass& operator+=(const Pass& o) &;
  };
  using Moves = std::vector<CellOrder::Move>;

  [[nodiscard]] std::size_t at(std::size_t p, std::size_t k) const { return k * stride_ + p; }
  void keep_places(std::size_t particles, std::string_view kernel, long locator, int parts);
  void forget();
  void narrow_window();
  void make_room(const Pass& pass);
  void sort_entries();
  bool set(std::size_t p, const Entries& found, Moves& moves);
  template <class Locator>
  [[nodiscard]] std::optional<cfd::Index3> cell_near(const Locator& locator, const Vec3& x,
                                                     std::size_t p) const;
  template <class Kernel, class Locator>
  void find_one(const Kernel& kernel, const Locator& locator, const ParticlesToPlace& particles,
                std::size_t p, std::uint8_t& placed, Pass& mine, Moves& moves);
  template <class Kernel, class Locator>
  Pass find_shares(const Kernel& kernel, const Locator& locator, const ParticlesToPlace& particles,
                   std::span<std::uint8_t> placed);

  Window window_;
  int builds_left_ = 0; ///< until window_ is looked at
  bool sorted_ = false; ///< by_cell_ lacks moves only
  // Rows of entries, each with one of every particle; a particle has as many as it needs. In the
  // second row a particle with one entry has its cell again, with no part.
  std::size_t particles_ = 0, stride_ = 0, rows_ = 0;
  std::vector<std::uint32_t> cell_; ///< in the window
  std::vector<std::uint8_t> parts_;
  std::array<double, 256> share_{};   ///< of as many parts
  std::vector<std::uint8_t> entries_; ///< of each particle
  CellOrder by_cell_;
  // Kept, so that memory is allocated once.
  std::vector<Moves> moves_;                     ///< of this build, [thread]
  std::vector<std::vector<std::uint32_t>> lost_; ///< particles to find anew, [thread]
  // Of kernels that tell room:
  std::vector<Found> found_; ///< of each particle
  std::string_view kernel_;
  long locator_ = 0; ///< edition
};

template <class Locator>
std::optional<cfd::Index3> ShareLists::cell_near(const Locator& locator, const Vec3& x,
                                                 std::size_t p) const {
  if constexpr (requires { locator.cell(x, cfd::Index3{}); })
    if (entries_[p] > 0)
      return locator.cell(x, window_.cell(cell_[at(p, 0)]));
  return locator.cell(x);
}

template <class Kernel, class Locator>
void ShareLists::find_one(const Kernel& kernel, const Locator& locator,
                          const ParticlesToPlace& particles, std::size_t p, std::uint8_t& placed,
                          Pass& mine, Moves& moves) {
  placed = 0;
  Entries entries;
  const auto emit = [&](const cfd::Index3& cell, double share) {
    entries.cell[entries.count] = cell;
    entries.parts[entries.count++] = std::uint8_t(std::lround(share * Kernel::parts));
  };
  [[maybe_unused]] Room room;
  if (particles.takes_part(p)) {
    const Vec3 centre = locator.fold(particles.position[p]);
    if (const auto cell = cell_near(locator, centre, p)) {
      const ParticlePlace place{centre, particles.radius[p], *cell};
      if constexpr (tells_room<Kernel, Locator>)
        room = kernel(locator, place, emit);
      else
        kernel(locator, place, emit);
      placed = 1;
      ++mine.placing.placed;
    } else {
      ++mine.placing.outside;
    }
    if constexpr (tells_room<Kernel, Locator>)
      found_[p] = {centre, particles.radius[p], room};
  } else if constexpr (tells_room<Kernel, Locator>) {
    found_[p] = {};
  }
  for (std::size_t k = 0; k < entries.count; ++k) {
    const cfd::Index3& c = entries.cell[k];
    mine.placing.include(c, {c[0] + 1, c[1] + 1, c[2] + 1});
  }
  mine.most_entries = std::max(mine.most_entries, entries.count);
  mine.fits &= set(p, entries, moves);
}

/// Each thread finds those of its own run that have none, or have gone too far for them.
template <class Kernel, class Locator>
ShareLists::Pass ShareLists::find_shares(const Kernel& kernel, const Locator& locator,
                                         const ParticlesToPlace& particles,
                                         std::span<std::uint8_t> placed) {
  std::vector<Pass> of_thread(moves_.size());
#pragma omp parallel
  {
    const int t = omp_get_thread_num(), n = omp_get_num_threads();
    std::vector<std::uint32_t>& lost = lost_[std::size_t(t)];
    const std::size_t begin = run_begin(particles_, t, n), end = run_begin(particles_, t + 1, n);
    lost.resize(end - begin);
    std::size_t count = 0;
    for (std::size_t p = begin; p < end; ++p) {
      bool serves = false;
      if constexpr (tells_room<Kernel, Locator>)
        serves = particles.takes_part(p) &
                 found_[p].serves(locator.fold(particles.position[p]), particles.radius[p]);
      placed[p] = serves;
      lost[count] = std::uint32_t(p);
      count += !serves;
    }
    Pass mine;
    mine.placing.placed = end - begin - count;
    for (const std::uint32_t p : std::span(lost).first(count))
      find_one(kernel, locator, particles, p, placed[p], mine, moves_[std::size_t(t)]);
    of_thread[std::size_t(t)] = mine;
  }
  Pass all;
  for (const Pass& pass : of_thread)
    all += pass;
  return all;
}

template <class Kernel, class Locator>
Placing ShareLists::build(const Kernel& kernel, const Locator& locator,
                          const ParticlesToPlace& particles, std::span<std::uint8_t> placed) {
  moves_.resize(std::size_t(omp_get_max_threads()));
  lost_.resize(moves_.size());
  for (Moves& of_thread : moves_)
    of_thread.clear();
  if constexpr (tells_room<Kernel, Locator>)
    keep_places(particles.size(), Kernel::name, locator.edition(), Kernel::parts);
  else
    keep_places(particles.size(), {}, 0, Kernel::parts);
  narrow_window();
  Pass pass = find_shares(kernel, locator, particles, placed);
  while (!pass.fits) {
    make_room(pass);
    pass = find_shares(kernel, locator, particles, placed);
  }
  if (pass.placing.placed == 0)
    forget();
  sort_entries();
  pass.placing.window = window_;
  return pass.placing;
}

// The entries of a cell are added up in the order of particles.
template <class T> void ShareLists::deposit(std::span<const T> value, std::span<T> field) const {
  static_assert(std::is_trivially_copyable_v<T> && sizeof(T) % sizeof(double) == 0);
  constexpr std::size_t numbers = sizeof(T) / sizeof(double);
  const auto* from = reinterpret_cast<const double*>(value.data());
  auto* to = reinterpret_cast<double*>(field.data());
  const std::span<const std::uint32_t> items = by_cell_.items();
  const auto cells = window_.size();
#pragma omp parallel for schedule(guided)
  for (std::size_t c = 0; c < cells; ++c) {
    std::array<double, numbers> sum{};
    const std::size_t end = by_cell_.end(c);
    for (std::size_t s = by_cell_.begin(c); s < end; ++s) {
      const std::size_t p = items[s] >> row_bits, k = items[s] & ((1u << row_bits) - 1);
      const double share = share_[parts_[at(p, k)]];
      for (std::size_t v = 0; v < numbers; ++v)
        sum[v] += share * from[numbers * p + v];
    }
    for (std::size_t v = 0; v < numbers; ++v)
      to[numbers * c + v] = sum[v];
  }
}

// Most particles have one entry or two, which of them no processor foretells.
template <class T> void ShareLists::sample(std::span<const T> field, std::span<T> value) const {
  static_assert(std::is_trivially_copyable_v<T> && sizeof(T) % sizeof(double) == 0);
  constexpr std::size_t numbers = sizeof(T) / sizeof(double);
  const auto* from = reinterpret_cast<const double*>(field.data());
  auto* to = reinterpret_cast<double*>(value.data());
#pragma omp parallel for schedule(static)
  for (std::size_t p = 0; p < particles_; ++p) {
    std::array<double, numbers> sum{};
    if (entries_[p] > 0) {
      const auto add = [&](std::size_t k) {
        const double* const q = from + numbers * cell_[at(p, k)];
        const double share = share_[parts_[at(p, k)]];
        for (std::size_t v = 0; v < numbers; ++v)
          sum[v] += share * q[v];
      };
      add(0);
      add(1);
      for (std::size_t k = 2; k < entries_[p]; ++k)
        add(k);
    }
    for (std::size_t v = 0; v < numbers; ++v)
      to[numbers * p + v] = sum[v];
  }
}

} // namespace granflux::coupling
