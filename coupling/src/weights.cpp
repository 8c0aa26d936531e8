// SPDX-FileCopyrightText: 2026 The GranFlux developers
// SPDX-License-Identifier: BSD-3-Clause
#include <granflux/coupling/weights.hpp>

#include <algorithm>
#include <limits>
#include <omp.h>
#include <utility>
#include <variant>

namespace granflux::coupling {

namespace {

/// Shares found by one thread for its run of consecutive particles.
struct Run {
  std::vector<cfd::Index3> cell;
  std::vector<double> share;
  std::size_t placed = 0, outside = 0;
};

/// First of the count items that thread t of n works on: consecutive runs, in the order of t.
std::size_t run_begin(std::size_t count, int t, int n) {
  return count * std::size_t(t) / std::size_t(n);
}

Window bounding_window(const std::vector<Run>& runs) {
  constexpr int most = std::numeric_limits<int>::max();
  Window box{{most, most, most}, {-most, -most, -most}};
  bool empty = true;
  for (const Run& run : runs)
    for (const auto& c : run.cell) {
      empty = false;
      for (std::size_t d = 0; d < 3; ++d) {
        box.lo[d] = std::min(box.lo[d], c[d]);
        box.hi[d] = std::max(box.hi[d], c[d] + 1);
      }
    }
  return empty ? Window{} : box;
}

} // namespace

void Weights::build(const AnyKernel& any_kernel, const LatticeLocator& lattice,
                    std::span<const Vec3> position, std::span<const double> radius,
                    std::span<const std::uint8_t> coupled) {
  const std::size_t count = position.size();
  offset_.assign(count + 1, 0);
  const int threads = omp_get_max_threads();
  auto runs = std::vector<Run>(std::size_t(threads));

  std::visit(
      [&](const auto& kernel) {
#pragma omp parallel
        {
          const int t = omp_get_thread_num(), n = omp_get_num_threads();
          Run& run = runs[std::size_t(t)];
          const std::size_t end = run_begin(count, t + 1, n);
          for (std::size_t p = run_begin(count, t, n); p < end; ++p) {
            if (!coupled.empty() && coupled[p] == 0)
              continue;
            const Vec3 centre = lattice.fold(position[p]);
            const auto cell = lattice.cell(centre);
            if (!cell) {
              ++run.outside;
              continue;
            }
            ++run.placed;
            const std::size_t before = run.cell.size();
            kernel(lattice, ParticlePlace{centre, radius[p], *cell},
                   [&](const cfd::Index3& c, double share) {
                     run.cell.push_back(c);
                     run.share.push_back(share);
                   });
            offset_[p + 1] = run.cell.size() - before;
          }
        }
      },
      any_kernel);

  for (std::size_t p = 0; p < count; ++p)
    offset_[p + 1] += offset_[p];
  window_ = bounding_window(runs);
  placed_ = outside_ = 0;
  std::vector<std::size_t> first(runs.size() + 1, 0);
  for (std::size_t t = 0; t < runs.size(); ++t) {
    placed_ += runs[t].placed;
    outside_ += runs[t].outside;
    first[t + 1] = first[t] + runs[t].cell.size();
  }
  cell_.resize(first.back());
  share_.resize(first.back());
#pragma omp parallel for schedule(static, 1)
  for (std::size_t t = 0; t < runs.size(); ++t)
    for (std::size_t e = 0; e < runs[t].cell.size(); ++e) {
      cell_[first[t] + e] = std::uint32_t(window_.index(runs[t].cell[e]));
      share_[first[t] + e] = runs[t].share[e];
    }
  transpose();
}

/// Counting sort of the entries by cell, stable, so that each cell keeps its particles in order.
/// Every thread counts the entries of its own run of particles; a running sum over cells, and
/// within a cell over threads, then says where each thread puts them.
void Weights::transpose() {
  const std::size_t cells = window_.size(), count = particles();
  cell_offset_.assign(cells + 1, 0);
  particle_.resize(cell_.size());
  cell_share_.resize(cell_.size());
  std::vector<std::vector<std::uint32_t>> tally; // [thread][cell]
#pragma omp parallel
  {
    const int t = omp_get_thread_num(), n = omp_get_num_threads();
#pragma omp single
    tally.resize(std::size_t(n));
    const std::size_t begin = run_begin(count, t, n), end = run_begin(count, t + 1, n);
    auto& mine = tally[std::size_t(t)];
    mine.assign(cells, 0);
    for (std::size_t e = offset_[begin]; e < offset_[end]; ++e)
      ++mine[cell_[e]];
#pragma omp barrier
#pragma omp for schedule(static)
    for (std::size_t c = 0; c < cells; ++c) {
      std::uint32_t before = 0;
      for (auto& of_thread : tally)
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
