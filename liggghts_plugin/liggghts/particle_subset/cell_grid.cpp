// SPDX-FileCopyrightText: 2026 The GranFlux developers
// SPDX-License-Identifier: GPL-2.0-or-later

#include "cell_grid.hpp"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <limits>

#include <omp.h>

#include "axis_order.hpp"
#include "subset.hpp"

namespace granflux::particle_subset {

namespace {

/// Cells that a dilute system may have for one particle.
constexpr double most_cells_per_particle = 4;

/// Of a cell without particles.
constexpr int above_all = std::numeric_limits<int>::max(), below_all = -1;

/// Whole cells from the origin; not-a-number goes to the first.
int whole(double cells) {
  return cells > 0 ? int(cells) : 0;
}

} // namespace

int CellGrid::cell_of(const Vec3& place) const {
  int cell = 0;
  for (int d = 0; d < 3; ++d)
    cell += stride_[d] *
            (1 + std::min(whole((place[d] - origin_[d]) * inverse_size_[d]), cells_[d] - 3));
  return cell;
}

std::array<CellGrid::Run, 9> CellGrid::around(const Vec3& place) const {
  std::array<Run, 9> runs;
  const int cell = cell_of(place);
  for (std::size_t r = 0; r < runs.size(); ++r) {
    const int middle =
        cell + (int(r / 3) - 1) * stride_of_layers_ + (int(r % 3) - 1) * stride_of_rows_;
    const int* const start = start_.data() + middle;
    const Numbers* const in = numbers_.data() + middle;
    runs[r] = {start[-1], start[2], std::min({in[-1].least, in[0].least, in[1].least}),
               std::max({in[-1].most, in[0].most, in[1].most})};
  }
  return runs;
}

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

void CellGrid::sort(const Particles& particles, double reach, int threads) {
  if (particles.all == 0)
    return;
  choose_cells(particles, reach, threads);
  const int cells = cells_[0] * cells_[1] * cells_[2];
  cell_.resize(std::size_t(particles.all));
  number_.resize(std::size_t(particles.all));
  entry_.resize(std::size_t(particles.all));
  start_.resize(std::size_t(cells) + 1);
  filled_.resize(std::size_t(cells));
  numbers_.resize(std::size_t(cells));
  std::vector<int> before(std::size_t(threads) + 1);

#pragma omp parallel num_threads(threads)
  {
    const int thread = omp_get_thread_num();
    const int team = omp_get_num_threads();
    const Range mine = Subset(particles.all, team).of(thread);
    const Range my_cells = Subset(cells, team).of(thread);
    std::fill(filled_.begin() + my_cells.begin, filled_.begin() + my_cells.end, 0);
#pragma omp barrier
    for (int p = mine.begin; p < mine.end; ++p) {
      const int c = cell_of(particles.position[p]);
      cell_[std::size_t(p)] = c;
      std::atomic_ref(filled_[std::size_t(c)]).fetch_add(1, std::memory_order_relaxed);
    }
#pragma omp barrier
    int sum = 0;
    for (int c = my_cells.begin; c < my_cells.end; ++c) {
      start_[std::size_t(c)] = sum;
      sum += filled_[std::size_t(c)];
    }
    before[std::size_t(thread) + 1] = sum;
#pragma omp barrier
    int offset = 0;
    for (int t = 0; t <= thread; ++t)
      offset += before[std::size_t(t)];
    for (int c = my_cells.begin; c < my_cells.end; ++c)
      start_[std::size_t(c)] += offset;
    if (thread == team - 1)
      start_[std::size_t(cells)] = particles.all;
#pragma omp barrier
    for (int p = mine.begin; p < mine.end; ++p) {
      const auto c = std::size_t(cell_[std::size_t(p)]);
      const int left = std::atomic_ref(filled_[c]).fetch_sub(1, std::memory_order_relaxed);
      number_[std::size_t(start_[c] + left - 1)] = p;
    }
#pragma omp barrier
    for (int c = my_cells.begin; c < my_cells.end; ++c) {
      const int begin = start_[std::size_t(c)], end = start_[std::size_t(c) + 1];
      std::sort(number_.begin() + begin, number_.begin() + end);
      numbers_[std::size_t(c)] =
          begin < end ? Numbers{number_[std::size_t(begin)], number_[std::size_t(end) - 1]}
                      : Numbers{above_all, below_all};
      for (int k = begin; k < end; ++k) {
        const int p = number_[std::size_t(k)];
        const Vec3& x = particles.position[p];
        entry_[std::size_t(k)] = {x.x, x.y, x.z, particles.radius[p]};
      }
    }
  }
}

} // namespace granflux::particle_subset
