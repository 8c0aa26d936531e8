// SPDX-FileCopyrightText: 2026 The GranFlux developers
// SPDX-License-Identifier: BSD-3-Clause
#include <granflux/coupling/weights.hpp>

#include <algorithm>
#include <limits>
#include <omp.h>
#include <stdexcept>
#include <type_traits>
#include <utility>
#include <variant>

namespace granflux::coupling {

namespace {

/// First of the count items that thread t of n works on: consecutive runs, in the order of t.
std::size_t run_begin(std::size_t count, int t, int n) {
  return count * std::size_t(t) / std::size_t(n);
}

constexpr int most = std::numeric_limits<int>::max();
constexpr Window nothing{{most, most, most}, {-most, -most, -most}}; // where a union begins

void include(Window& window, const cfd::Index3& lo, const cfd::Index3& hi) {
  for (std::size_t d = 0; d < 3; ++d) {
    window.lo[d] = std::min(window.lo[d], lo[d]);
    window.hi[d] = std::max(window.hi[d], hi[d]);
  }
}

} // namespace

/// Shares of all particles, each thread's in its own run.
template <class Kernel, class Locator>
void Weights::find_shares(const Kernel& kernel, const Locator& locator,
                          std::span<const Vec3> position, std::span<const double> radius,
                          std::span<const std::uint8_t> coupled) {
  const std::size_t count = position.size();
#pragma omp parallel
  {
    const int t = omp_get_thread_num(), n = omp_get_num_threads();
    Run& run = runs_[std::size_t(t)];
    const std::size_t end = run_begin(count, t + 1, n);
    for (std::size_t p = run_begin(count, t, n); p < end; ++p) {
      if (!coupled.empty() && coupled[p] == 0)
        continue;
      const Vec3 centre = locator.fold(position[p]);
      const auto cell = locator.cell(centre);
      if (!cell) {
        ++run.outside;
        continue;
      }
      ++run.placed;
      const std::size_t before = run.entries.size();
      kernel(locator, ParticlePlace{centre, radius[p], *cell},
             [&](const cfd::Index3& c, double share) {
               if (!run.window.contains(c)) [[unlikely]]
                 include(run.window, c, {c[0] + 1, c[1] + 1, c[2] + 1});
               run.entries.push_back({c, share});
             });
      offset_[p + 1] = run.entries.size() - before;
    }
  }
}

void Weights::build(const AnyKernel& any_kernel, const AnyLocator& any_locator,
                    std::span<const Vec3> position, std::span<const double> radius,
                    std::span<const std::uint8_t> coupled) {
  const std::size_t count = position.size();
  offset_.assign(count + 1, 0);
  runs_.resize(std::size_t(omp_get_max_threads()));
  for (Run& run : runs_) {
    run.entries.clear();
    run.placed = run.outside = 0;
    run.window = nothing;
  }

  std::visit(
      [&](const auto kernel, const auto& locator) {
        if constexpr (serves<decltype(kernel), std::remove_cvref_t<decltype(locator)>>)
          find_shares(kernel, locator, position, radius, coupled);
        else
          throw std::logic_error("a kernel for lattices was given another grid");
      },
      any_kernel, any_locator);

  for (std::size_t p = 0; p < count; ++p)
    offset_[p + 1] += offset_[p];
  window_ = nothing;
  placed_ = outside_ = 0;
  for (const Run& run : runs_) {
    include(window_, run.window.lo, run.window.hi);
    placed_ += run.placed;
    outside_ += run.outside;
  }
  if (placed_ == 0)
    window_ = {};
  number_cells();
  transpose();
}

/// Joins what the threads found, cells by their place in the window.
void Weights::number_cells() {
  std::vector<std::size_t> first(runs_.size() + 1, 0);
  for (std::size_t t = 0; t < runs_.size(); ++t)
    first[t + 1] = first[t] + runs_[t].entries.size();
  cell_.resize(first.back());
  share_.resize(first.back());
#pragma omp parallel for schedule(static, 1)
  for (std::size_t t = 0; t < runs_.size(); ++t)
    for (std::size_t e = 0; e < runs_[t].entries.size(); ++e) {
      const auto& [cell, share] = runs_[t].entries[e];
      cell_[first[t] + e] = std::uint32_t(window_.index(cell));
      share_[first[t] + e] = share;
    }
}

/// Counting sort of the entries by cell, stable, so that each cell keeps its particles in order.
/// Every thread counts the entries of its own run of particles; a running sum over cells, and
/// within a cell over threads, then says where each thread puts them.
void Weights::transpose() {
  const std::size_t cells = window_.size(), count = particles();
  cell_offset_.assign(cells + 1, 0);
  particle_.resize(cell_.size());
  cell_share_.resize(cell_.size());
#pragma omp parallel
  {
    const int t = omp_get_thread_num(), n = omp_get_num_threads();
#pragma omp single
    tally_.resize(std::size_t(n));
    const std::size_t begin = run_begin(count, t, n), end = run_begin(count, t + 1, n);
    auto& mine = tally_[std::size_t(t)];
    mine.assign(cells, 0);
    for (std::size_t e = offset_[begin]; e < offset_[end]; ++e)
      ++mine[cell_[e]];
#pragma omp barrier
#pragma omp for schedule(static)
    for (std::size_t c = 0; c < cells; ++c) {
      std::uint32_t before = 0;
      for (auto& of_thread : tally_)
        before += std::exchange(of_thread[c], before);
      cell_offset_[c + 1] = before;
    }
#pragma omp single
    for (std::size_t c = 0; c < cells; ++c)
      cell_offset_[c + 1] += cell_offset_[c];
    for (std::size_t p = begin; p < end; ++p)
      for (std::size_t e = offset_[p]; e < offset_[p + 1]; ++e) {
        const std::size_t c = cell_[e], to = cell_offset_[c] + mine[c]++;
        particle_[to] = std::uint32_t(p);
        cell_share_[to] = share_[e];
      }
  }
}

} // namespace granflux::coupling
