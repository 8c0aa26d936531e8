// SPDX-FileCopyrightText: 2026 The GranFlux developers
// SPDX-License-Identifier: BSD-3-Clause
#include <granflux/coupling/cube_shares.hpp>

#include <algorithm>
#include <omp.h>

namespace granflux::coupling {

template <int n>
Placing CubeShares<n>::build(const SplineKernel<n>& kernel, const LatticeLocator& lattice,
                             const ParticlesToPlace& particles, std::span<std::uint8_t> placed) {
  const std::size_t count = particles.size();
  of_particle_.resize(count);
  std::vector<Placing> of_thread(static_cast<std::size_t>(omp_get_max_threads()));
  // Along a direction of fewer than n cells the last of them stands for those beyond, whose shares
  // are 0.
  cfd::Index3 many;
  for (int d = 0; d < 3; ++d)
    many[std::size_t(d)] = lattice.axis(d).periodic() ? n : std::min(n, lattice.axis(d).cells());
#pragma omp parallel
  {
    const int t = omp_get_thread_num(), threads = omp_get_num_threads();
    Placing mine;
    const std::size_t end = run_begin(count, t + 1, threads);
    for (std::size_t p = run_begin(count, t, threads); p < end; ++p) {
      placed[p] = 0;
      if (!particles.takes_part(p))
        continue;
      const auto cube = kernel.cube(lattice, lattice.fold(particles.position[p]));
      if (!cube) {
        ++mine.outside;
        continue;
      }
      placed[p] = 1;
      ++mine.placed;
      of_particle_[p] = *cube;
      const cfd::Index3& low = cube->lowest;
      mine.include(low, {low[0] + many[0], low[1] + many[1], low[2] + many[2]});
    }
    of_thread[std::size_t(t)] = mine;
  }
  Placing all;
  for (const Placing& mine : of_thread)
    all += mine;
  if (all.placed == 0)
    all.window = {};
  window_ = all.window;
  all_placed_ = all.placed == count;

  const cfd::Index3 extent = window_.extent();
  std::size_t next = 0;
  for (int k = 0; k < n; ++k)
    for (int j = 0; j < n; ++j)
      for (int i = 0; i < n; ++i)
        offset_[next++] = std::size_t(std::min(i, many[0] - 1)) +
                          std::size_t(extent[0]) *
                              (std::size_t(std::min(j, many[1] - 1)) +
                               std::size_t(extent[1]) * std::size_t(std::min(k, many[2] - 1)));

  particle_.resize(all.placed);
  lowest_.resize(all.placed);
  others_.resize(all.placed);
  by_cell_.sort(
      window_.size(),
      [&](int t, int threads, auto&& visit) {
        const std::size_t end = run_begin(count, t + 1, threads);
        for (std::size_t p = run_begin(count, t, threads); p < end; ++p)
          if (placed[p])
            visit(window_.index(of_particle_[p].lowest), p);
      },
      [&](std::size_t p, std::size_t cell, std::size_t place) {
        particle_[place] = std::uint32_t(p);
        lowest_[place] = std::uint32_t(cell);
        others_[place] = of_particle_[p].others;
      });
  return all;
}

template class CubeShares<2>;
template class CubeShares<3>;

} // namespace granflux::coupling
