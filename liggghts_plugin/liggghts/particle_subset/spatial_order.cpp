// SPDX-FileCopyrightText: 2026 The GranFlux developers
// SPDX-License-Identifier: GPL-2.0-or-later

#include "spatial_order.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numeric>

#include <liggghts/atom.h>

#include "axis_order.hpp"
#include "reorder.hpp"

namespace granflux::particle_subset {

namespace {

using Three = std::array<double, 3>;

struct Extent {
  Three low, size;
};

Extent extent_of(const LAMMPS_NS::Atom& atom) {
  constexpr double most = std::numeric_limits<double>::max();
  Three low{most, most, most}, high{-most, -most, -most};
  for (int i = 0; i < atom.nlocal; ++i)
    for (int d = 0; d < 3; ++d) {
      low[d] = std::min(low[d], atom.x[i][d]);
      high[d] = std::max(high[d], atom.x[i][d]);
    }
  return {low, {high[0] - low[0], high[1] - low[1], high[2] - low[2]}};
}

} // namespace

void SpatialOrder::sort(LAMMPS_NS::Atom& atom, LAMMPS_NS::Modify& modify, double size) {
  const int count = atom.nlocal;
  if (count < 2 || !(size > 0))
    return;
  const Extent extent = extent_of(atom);

  const std::array<int, 3> axes = axis_order(extent.size, size); // the quickest to change first

  constexpr double cells_a_particle = 16; // counting them takes less time than moving the particle
  const auto cells_along = [&](int d) { return std::floor(extent.size[d] / size) + 1; };
  while (cells_along(0) * cells_along(1) * cells_along(2) > cells_a_particle * count + 64)
    size *= 2;

  Three stride{};
  double cells = 1;
  for (const int d : axes) {
    stride[d] = cells;
    cells *= cells_along(d);
  }
  start_.assign(std::size_t(cells) + 1, 0);
  cell_.resize(std::size_t(count));
  for (int i = 0; i < count; ++i) {
    double cell = 0;
    for (int d = 0; d < 3; ++d)
      cell += stride[d] * std::floor((atom.x[i][d] - extent.low[d]) / size);
    cell_[i] = int(cell);
    ++start_[std::size_t(cell_[i]) + 1];
  }
  std::partial_sum(start_.begin(), start_.end(), start_.begin());
  from_.resize(std::size_t(count));
  for (int i = 0; i < count; ++i)
    from_[std::size_t(start_[cell_[i]]++)] = i;
  reorder(atom, modify, from_);
}

} // namespace granflux::particle_subset
