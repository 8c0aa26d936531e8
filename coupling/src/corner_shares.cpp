// SPDX-FileCopyrightText: 2026 The GranFlux developers
// SPDX-License-Identifier: BSD-3-Clause
#include <granflux/coupling/corner_shares.hpp>

#include <omp.h>

namespace granflux::coupling {

Placing CornerShares::build(const Trilinear& kernel, const LatticeLocator& lattice,
                            const ParticlesToPlace& particles, std::span<std::uint8_t> placed) {
  const std::size_t count = particles.size();
  of_particle_.resize(count);
  std::vector<Placing> of_thread(static_cast<std::size_t>(omp_get_max_threads()));
  // Along a direction of one cell that cell is both the lower and the upper one.
  cfd::Index3 step;
  for (int d = 0; d < 3; ++d)
    step[std::size_t(d)] = lattice.axis(d).cells() > 1 || lattice.axis(d).periodic() ? 1 : 0;
#pragma omp parallel
  {
    const int t = omp_get_thread_num(), n = omp_get_num_threads();
    Placing mine;
    const std::size_t end = run_begin(count, t + 1, n);
    for (std::size_t p = run_begin(count, t, n); p < end; ++p) {
      placed[p] = 0;
      if (!particles.takes_part(p))
        continue;
      const auto corners = kernel.corners(lattice, lattice.fold(particles.position[p]));
      if (!corners) {
        ++mine.outside;
        continue;
      }
      placed[p] = 1;
      ++mine.placed;
      of_particle_[p] = *corners;
      const cfd::Index3& low = corners->lowest;
      mine.include(low, {low[0] + step[0] + 1, low[1] + step[1] + 1, low[2] + step[2] + 1});
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

  const cfd::Index3 n = window_.extent();
  const std::size_t along[3] = {std::size_t(step[0]), std::size_t(step[1] * n[0]),
                                std::size_t(step[2]) * std::size_t(n[0]) * std::size_t(n[1])};
  for (std::size_t c = 0; c < 8; ++c)
    corner_[c] = (c & 1) * along[0] + (c >> 1 & 1) * along[1] + (c >> 2) * along[2];

  particle_.resize(all.placed);
  lowest_.resize(all.placed);
  upper_.resize(all.placed);
  cells_.sort(
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
        upper_[place] = of_particle_[p].upper;
      });
  return all;
}

} // namespace granflux::coupling
