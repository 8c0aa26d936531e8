// SPDX-FileCopyrightText: 2026 The GranFlux developers
// SPDX-License-Identifier: BSD-3-Clause
#include <granflux/coupling/cube_shares.hpp>

#include <algorithm>
#include <omp.h>
#include <utility>

#include "linear_places.hpp"

namespace granflux::coupling {

namespace {

/// Cells of a cube that there are along each direction: along one of fewer than n cells the last of
/// them stands for those beyond, whose shares are 0.
cfd::Index3 widths(const LatticeLocator& lattice, int n) {
  cfd::Index3 many;
  for (int d = 0; d < 3; ++d)
    many[std::size_t(d)] = lattice.axis(d).periodic() ? n : std::min(n, lattice.axis(d).cells());
  return many;
}

bool within(const Window& window, const LatticeLocator& lattice) {
  for (int d = 0; d < 3; ++d)
    if (const auto i = std::size_t(d);
        !lattice.axis(d).periodic() && (window.lo[i] < 0 || window.hi[i] > lattice.axis(d).cells()))
      return false;
  return true;
}

cfd::Index3 sum(const cfd::Index3& a, const cfd::Index3& b) {
  return {a[0] + b[0], a[1] + b[1], a[2] + b[2]};
}

/// Calls body(begin, end, placing) with the run of particles of each thread.
template <class Body> Placing over_runs(std::size_t count, Body&& body) {
  std::vector<Placing> of_thread(static_cast<std::size_t>(omp_get_max_threads()));
#pragma omp parallel
  {
    const int t = omp_get_thread_num(), threads = omp_get_num_threads();
    Placing mine;
    body(run_begin(count, t, threads), run_begin(count, t + 1, threads), mine);
    of_thread[std::size_t(t)] = mine;
  }
  Placing all;
  for (const Placing& mine : of_thread)
    all += mine;
  return all;
}

} // namespace

/// Tight around the cells of all particles.
template <int n>
Window CubeShares<n>::find_window(const SplineKernel<n>& kernel, const LatticeLocator& lattice,
                                  const ParticlesToPlace& particles) {
  const cfd::Index3 many = widths(lattice, n);
  const auto look = [&](std::size_t begin, std::size_t end, Placing& mine) {
    for (std::size_t p = begin; p < end; ++p)
      if (particles.takes_part(p))
        if (const auto cube = kernel.cube(lattice, lattice.fold(particles.position[p]))) {
          ++mine.placed;
          mine.include(cube->lowest, sum(cube->lowest, many));
        }
  };
  const Placing all = over_runs(particles.size(), look);
  return all.placed > 0 ? all.window : Window{};
}

template <int n> void CubeShares<n>::set_lowest(std::size_t p, std::uint32_t cell, Moves& moves) {
  if (lowest_[p] != cell) [[unlikely]]
    moves.push_back({std::uint32_t(p), std::exchange(lowest_[p], cell), cell});
}

/// False where it has left the cells that may be the lowest of a cube in the window.
template <int n>
bool CubeShares<n>::place(std::size_t p, const CellCube<n>& cube, const Window& lowest,
                          Moves& moves) {
  set_lowest(p, std::uint32_t(window_.index(cube.lowest)), moves);
  others_[p] = cube.others;
  return lowest.contains(cube.lowest);
}

/// Places particles all of which take part by arithmetic on vector registers. Says how many of
/// `count`: fewer where one has left the window or the box, and those that are too few.
template <int n>
std::size_t CubeShares<n>::place_together(const std::optional<LinearPlaces>& places,
                                          const Vec3* position, std::size_t first,
                                          std::size_t count, Moves& moves) {
  std::size_t done = 0;
  if constexpr (n == 2)
    for (constexpr std::size_t some = LinearPlaces::together; places && done + some <= count;
         done += some) {
      const std::size_t p = first + done;
      std::array<std::uint32_t, some> cell;
      if (!places->find(&position[p].x, cell.data(), others_[p].front().data()))
        break;
      std::uint32_t changed = 0;
      for (std::size_t i = 0; i < some; ++i)
        changed |= cell[i] ^ lowest_[p + i];
      if (changed != 0) [[unlikely]]
        for (std::size_t i = 0; i < some; ++i)
          set_lowest(p + i, cell[i], moves);
    }
  return done;
}

/// Nothing where a particle has left the window.
template <int n>
std::optional<Placing>
CubeShares<n>::place_all(const SplineKernel<n>& kernel, const LatticeLocator& lattice,
                         const ParticlesToPlace& particles, std::span<std::uint8_t> placed) {
  const cfd::Index3 many = widths(lattice, n);
  const Window lowest{
      window_.lo,
      {window_.hi[0] - many[0] + 1, window_.hi[1] - many[1] + 1, window_.hi[2] - many[2] + 1}};
  const auto places = n == 2 && particles.coupled.empty()
                          ? LinearPlaces::make(lattice, window_, lowest)
                          : std::nullopt;
  bool left = false;
  Placing all = over_runs(particles.size(), [&](std::size_t begin, std::size_t end, Placing& mine) {
    Moves& moves = moves_[std::size_t(omp_get_thread_num())];
    bool one_left = false;
    for (std::size_t p = begin; p < end;) {
      const std::size_t done = place_together(places, particles.position.data(), p, end - p, moves);
      std::fill_n(placed.begin() + std::ptrdiff_t(p), done, 1);
      mine.placed += done;
      p += done;
      for (const std::size_t last = std::min(p + LinearPlaces::together, end); p < last; ++p) {
        const auto cube = particles.takes_part(p)
                              ? kernel.cube(lattice, lattice.fold(particles.position[p]))
                              : std::nullopt;
        placed[p] = cube.has_value();
        if (cube) {
          ++mine.placed;
          one_left |= !place(p, *cube, lowest, moves);
        } else {
          mine.outside += particles.takes_part(p);
          set_lowest(p, CellOrder::nowhere, moves);
        }
      }
    }
    if (one_left)
#pragma omp atomic write
      left = true;
  });
  if (left)
    return std::nullopt;
  all.window = window_;
  return all;
}

template <int n>
Placing CubeShares<n>::build(const SplineKernel<n>& kernel, const LatticeLocator& lattice,
                             const ParticlesToPlace& particles, std::span<std::uint8_t> placed) {
  constexpr int keep_window =
      64; // builds, before it is looked at anew: particles may have drawn together
  bool sorted = lowest_.size() == particles.size();
  lowest_.resize(particles.size());
  others_.resize(particles.size());
  moves_.resize(std::size_t(omp_get_max_threads()));
  for (Moves& of_thread : moves_)
    of_thread.clear();
  std::optional<Placing> all;
  if (builds_left_ > 0 && within(window_, lattice)) {
    --builds_left_;
    all = place_all(kernel, lattice, particles, placed);
  }
  if (!all || all->placed == 0) {
    sorted = false;
    window_ = find_window(kernel, lattice, particles);
    builds_left_ = keep_window;
    all = place_all(kernel, lattice, particles, placed);
  }

  const cfd::Index3 many = widths(lattice, n), extent = window_.extent();
  std::size_t next = 0;
  for (int k = 0; k < n; ++k)
    for (int j = 0; j < n; ++j)
      for (int i = 0; i < n; ++i)
        offset_[next++] = std::size_t(std::min(i, many[0] - 1)) +
                          std::size_t(extent[0]) *
                              (std::size_t(std::min(j, many[1] - 1)) +
                               std::size_t(extent[1]) * std::size_t(std::min(k, many[2] - 1)));
  if (!sorted || !by_cell_.mend(moves_))
    by_cell_.sort(window_.size(), [&](int t, int threads, auto&& visit) {
      const std::size_t end = run_begin(lowest_.size(), t + 1, threads);
      for (std::size_t p = run_begin(lowest_.size(), t, threads); p < end; ++p)
        if (lowest_[p] != CellOrder::nowhere)
          visit(lowest_[p], std::uint32_t(p));
    });
  return *all;
}

template class CubeShares<2>;
template class CubeShares<3>;

} // namespace granflux::coupling
