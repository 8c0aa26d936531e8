// SPDX-FileCopyrightText: 2026 The GranFlux developers
// SPDX-License-Identifier: GPL-2.0-or-later

#include "cell_grid.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include <omp.h>

#include "axis_order.hpp"
#include "subset.hpp"

namespace granflux::particle_subset {

namespace {

/// Cells that a dilute system may have for one particle.
constexpr double most_cells_per_particle = 4;

/// Of a cell without particles.
constexpr int above_all = std::numeric_limits<int>::max(), below_all = -1;

} // namespace

void CellGrid::choose_cells(const Particles& particles, double reach, int threads) {
  constexpr double infinity = std::numeric_limits<double>::infinity();
  double low[3] = {infinity, infinity, infinity}, high[3] = {-infinity, -infinity, -infinity};
#pragma omp parallel for num_threads(threads) schedule(static) reduction(min                       \
                                                                         : low[:3])                \
    reduction(max                                                                                  \
              : high[:3])
  for (int p = 0; p < particles.all; ++p)
    for (int d = 0; d < 3; ++d) {
      low[d] = std::min(low[d], particles.position[p][d]);
      high[d] = std::max(high[d], particles.position[p][d]);
    }
  // A margin, so that the farthest particle is inside whatever the rounding.
  constexpr double margin = 1e-6;
  double extent[3], volume = 1;
  for (int d = 0; d < 3; ++d) {
    extent[d] = std::max(high[d] - low[d], 0.0) + 2 * margin * reach;
    origin_[d] = low[d] - margin * reach;
    volume *= std::max(extent[d] / reach, 1.0);
  }
  const double most = most_cells_per_particle * particles.all + 1;
  const double size = reach * std::max(std::cbrt(volume / most), 1.0);
  for (int d = 0; d < 3; ++d) {
    const int used = std::max(whole(extent[d] / size), 1);
    cells_[d] = used + 2;
    inverse_size_[d] = used / extent[d];
  }
  const auto [within, rows, layers] = axis_order(extent, 0.5 * reach);
  stride_[within] = 1;
  stride_[rows] = stride_of_rows_ = cells_[within];
  stride_[layers] = stride_of_layers_ = cells_[within] * cells_[rows];
}

CellGrid::Run CellGrid::run_around(int cell) const {
  const int* const start = start_.data() + cell;
  Run run{start[-1], start[2], above_all, below_all};
  for (int c = -1; c <= 1; ++c)
    if (start[c] < start[c + 1]) {
      run.least = std::min(run.least, number_[std::size_t(start[c])]);
      run.most = std::max(run.most, number_[std::size_t(start[c + 1]) - 1]);
    }
  return run;
}

void CellGrid::sort(const Particles& particles, double reach, int threads) {
  const auto all = std::size_t(particles.all);
  for (std::vector<double>* column : {&x_, &y_, &z_, &radius_})
    column->resize(all + lanes);
  number_.resize(all + lanes);
  cell_.resize(all);
  longest_run_ = 0;
  if (all == 0)
    return;
  choose_cells(particles, reach, threads);
  const int cells = cells_[0] * cells_[1] * cells_[2];
  start_.resize(std::size_t(cells) + 1);
  start_[0] = 0;
  run_.resize(std::size_t(cells));
  strays_.resize(std::size_t(threads));
  std::vector<int> before(std::size_t(threads) + 1);
  int longest = 0;

  // Each cell is filled by one thread, in the order of the numbers. As far as particles are sorted
  // by place they are that thread's own, else they are told of as strays.
#pragma omp parallel num_threads(threads) reduction(max : longest)
  {
    const int thread = omp_get_thread_num();
    const int team = omp_get_num_threads();
    const Range mine = Subset(particles.all, team).of(thread);
    const Range my_cells = Subset(cells, team).of(thread);
    int* const next = start_.data() + 1; // where the next particle of a cell goes
    std::vector<int>& strays = strays_[std::size_t(thread)];
    strays.clear();
    std::fill(next + my_cells.begin, next + my_cells.end, 0);
    const auto each_in_my_cells = [&](auto visit) {
      for (int t = 0; t < team; ++t)
        if (t == thread) {
          for (int p = mine.begin; p < mine.end; ++p)
            if (my_cells.holds(cell_[std::size_t(p)]))
              visit(p);
        } else {
          for (const int p : strays_[std::size_t(t)])
            if (my_cells.holds(cell_[std::size_t(p)]))
              visit(p);
        }
    };
    for (int p = mine.begin; p < mine.end; ++p) {
      const int c = cell_of(particles.position[p]);
      cell_[std::size_t(p)] = c;
      if (!my_cells.holds(c))
        strays.push_back(p);
    }
#pragma omp barrier
    each_in_my_cells([&](int p) { ++next[cell_[std::size_t(p)]]; });
    int sum = 0;
    for (int c = my_cells.begin; c < my_cells.end; ++c)
      sum += std::exchange(next[c], sum);
    before[std::size_t(thread) + 1] = sum;
#pragma omp barrier
    int offset = 0;
    for (int t = 0; t <= thread; ++t)
      offset += before[std::size_t(t)];
    for (int c = my_cells.begin; c < my_cells.end; ++c)
      next[c] += offset;
    each_in_my_cells([&](int p) {
      const auto k = std::size_t(next[cell_[std::size_t(p)]]++);
      const Vec3& place = particles.position[p];
      x_[k] = place.x, y_[k] = place.y, z_[k] = place.z;
      radius_[k] = particles.radius[p];
      number_[k] = p;
    });
#pragma omp barrier
    for (int c = std::max(my_cells.begin, 1); c < std::min(my_cells.end, cells - 1); ++c) {
      run_[std::size_t(c)] = run_around(c);
      longest = std::max(longest, run_[std::size_t(c)].end - run_[std::size_t(c)].begin);
    }
  }
  longest_run_ = longest;
}

} // namespace granflux::particle_subset
