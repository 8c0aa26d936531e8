// SPDX-FileCopyrightText: 2026 The GranFlux developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <omp.h>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include <granflux/coupling/counting_sort.hpp>
#include <granflux/coupling/kernel/kernels.hpp>
#include <granflux/coupling/placing.hpp>

namespace granflux::coupling {

/// Shares of particles in any cells, as lists: of cells for each particle, and of particles for
/// each cell.
class ShareLists {
public:
  /// `placed`[p] is set to whether p is coupled and inside the grid.
  template <class Kernel, class Locator>
  Placing build(const Kernel& kernel, const Locator& locator, const ParticlesToPlace& particles,
                std::span<std::uint8_t> placed);

  /// Window cells that particle p touches, and its shares in them.
  [[nodiscard]] std::span<const std::uint32_t> cells(std::size_t p) const {
    return {cell_.data() + offset_[p], offset_[p + 1] - offset_[p]};
  }
  [[nodiscard]] std::span<const double> shares(std::size_t p) const {
    return {share_.data() + offset_[p], offset_[p + 1] - offset_[p]};
  }

  /// As in Weights.
  template <class T> void deposit(std::span<const T> value, std::span<T> field) const;
  template <class T> void sample(std::span<const T> field, std::span<T> value) const;

private:
  /// Shares found by one thread for its run of consecutive particles.
  struct Run {
    struct Entry {
      cfd::Index3 cell;
      double share;
    };
    std::vector<Entry> entries;
    Placing placing;
    std::size_t begin = 0, end = 0; ///< particles
    std::vector<Entry> before;      ///< entries of the last build
  };
  /// The place for which the shares of a particle were found. They are kept while it is near.
  struct Found {
    Vec3 centre;
    double radius = 0;
    double room = 0; ///< how far it may move; not above 0: its shares are found anew
    cfd::Index3 cell{};
    int entries = 0; ///< in Run::before
    [[nodiscard]] bool serves(const Vec3& x, double r) const {
      return room > 0 && r == radius && dot(x - centre, x - centre) < room * room;
    }
  };

  /// What the last build found is kept if it was for as many particles by the same kernel and
  /// locator.
  void keep_found(std::size_t particles, std::string_view kernel, long locator);
  template <class Locator>
  static std::optional<cfd::Index3> cell_near(const Locator& locator, const Vec3& x,
                                              const Found& last);
  template <class Kernel, class Locator>
  void find_shares(const Kernel& kernel, const Locator& locator, const ParticlesToPlace& particles,
                   std::span<std::uint8_t> placed);
  void join(Placing& all);

  Window window_;
  // particle -> cells, by particle
  std::vector<std::size_t> offset_{0};
  std::vector<std::uint32_t> cell_;
  std::vector<double> share_;
  // cell -> particles, each cell's in particle order
  CountingSort cells_;
  std::vector<std::uint32_t> particle_;
  std::vector<double> cell_share_;
  std::vector<Run> runs_; ///< kept from build to build, so that it allocates once
  // Of kernels that tell room.
  std::vector<Found> found_; ///< of each particle
  std::string_view kernel_;
  long locator_ = 0; ///< edition
};

template <class Locator>
std::optional<cfd::Index3> ShareLists::cell_near(const Locator& locator, const Vec3& x,
                                                 const Found& last) {
  if constexpr (requires { locator.cell(x, last.cell); })
    if (last.entries > 0)
      return locator.cell(x, last.cell);
  return locator.cell(x);
}

/// Each thread finds those of its own run.
template <class Kernel, class Locator>
void ShareLists::find_shares(const Kernel& kernel, const Locator& locator,
                             const ParticlesToPlace& particles, std::span<std::uint8_t> placed) {
  constexpr bool keeps = tells_room<Kernel, Locator>;
  const std::size_t count = particles.size();
#pragma omp parallel
  {
    const int t = omp_get_thread_num(), n = omp_get_num_threads();
    Run& run = runs_[std::size_t(t)];
    const std::size_t begin = run_begin(count, t, n), end = run_begin(count, t + 1, n);
    // What was found by another thread lies elsewhere.
    const bool same_run = keeps && run.begin == begin && run.end == end;
    run.begin = begin;
    run.end = end;
    auto before = run.before.begin(); // entries of the particle in the last build
    for (std::size_t p = begin; p < end; ++p) {
      placed[p] = 0;
      Found now;
      [[maybe_unused]] Found last;
      if constexpr (keeps)
        if (same_run)
          last = found_[p];
      const auto last_entries = before;
      before += last.entries;
      const auto add = [&](const cfd::Index3& c, double share) {
        if (!run.placing.window.contains(c)) [[unlikely]]
          run.placing.include(c, {c[0] + 1, c[1] + 1, c[2] + 1});
        run.entries.push_back({c, share});
        ++now.entries;
      };
      if (particles.takes_part(p)) {
        const Vec3 centre = locator.fold(particles.position[p]);
        if (last.serves(centre, particles.radius[p])) {
          for (auto e = last_entries; e != before; ++e)
            add(e->cell, e->share);
          now = last;
          placed[p] = 1;
        } else if (const auto cell = cell_near(locator, centre, last)) {
          const ParticlePlace place{centre, particles.radius[p], *cell};
          if constexpr (keeps) {
            now.room = kernel(locator, place, add);
            now.centre = centre;
            now.radius = place.radius;
            now.cell = *cell;
          } else {
            kernel(locator, place, add);
          }
          placed[p] = 1;
        }
        run.placing.placed += placed[p];
        run.placing.outside += 1u - placed[p];
      }
      if constexpr (keeps)
        found_[p] = now;
      offset_[p + 1] = std::size_t(now.entries);
    }
  }
}

template <class Kernel, class Locator>
Placing ShareLists::build(const Kernel& kernel, const Locator& locator,
                          const ParticlesToPlace& particles, std::span<std::uint8_t> placed) {
  offset_.assign(particles.size() + 1, 0);
  runs_.resize(std::size_t(omp_get_max_threads()));
  if constexpr (tells_room<Kernel, Locator>)
    keep_found(particles.size(), Kernel::name, locator.edition());
  else
    kernel_ = {}; // the runs are of other shares
  for (Run& run : runs_) {
    run.entries.clear();
    run.placing = {};
  }
  find_shares(kernel, locator, particles, placed);
  Placing all;
  join(all);
  return all;
}

template <class T> void ShareLists::deposit(std::span<const T> value, std::span<T> field) const {
  const auto cells = std::ptrdiff_t(window_.size());
#pragma omp parallel for schedule(guided)
  for (std::ptrdiff_t c = 0; c < cells; ++c) {
    T sum{};
    for (std::size_t e = cells_.begin(std::size_t(c)); e < cells_.end(std::size_t(c)); ++e)
      sum += value[particle_[e]] * cell_share_[e];
    field[std::size_t(c)] = sum;
  }
}

template <class T> void ShareLists::sample(std::span<const T> field, std::span<T> value) const {
  const auto count = std::ptrdiff_t(offset_.size()) - 1;
#pragma omp parallel for schedule(static)
  for (std::ptrdiff_t p = 0; p < count; ++p) {
    T sum{};
    for (std::size_t e = offset_[std::size_t(p)]; e < offset_[std::size_t(p) + 1]; ++e)
      sum += field[cell_[e]] * share_[e];
    value[std::size_t(p)] = sum;
  }
}

} // namespace granflux::coupling
