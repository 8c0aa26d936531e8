// SPDX-FileCopyrightText: 2026 The GranFlux developers
// SPDX-License-Identifier: BSD-3-Clause
#include "void_fraction.hpp"

#include <algorithm>
#include <cmath>

#include <granflux/cfd/error.hpp>
#include <granflux/cfd/sweep.hpp>
#include <granflux/coupling/throw_together.hpp>

#include "particle_sums.hpp"
#include "text_of_number.hpp"

namespace granflux::coupling {

VoidFraction::VoidFraction(const cfd::Mesh& mesh, double floor)
    : field(cfd::make_fields(mesh, 1)), mesh_(mesh), floor_(floor) {
  if (!(floor > 0 && floor < 1))
    throw ConfigError("coupling: void_fraction_floor = " + text(floor) +
                      " must lie between 0 and 1");
}

void VoidFraction::find(const ParticleView& view, GridTransfer& transfer, ExchangeSums& sums) {
  volume_.resize(view.size());
  const auto of_block = [&](std::size_t first, std::size_t count, ExchangeSums& mine) {
    Lanes volume{};
    for (std::size_t i = 0; i < count; ++i)
      volume[i] = transfer.placed(first + i) ? sphere_volume(view.radius[first + i]) : 0;
    std::copy_n(volume.of.begin(), count, volume_.begin() + std::ptrdiff_t(first));
    mine.particle_volume += sum(volume);
  };
  sums += sum_blocks<ExchangeSums>(view.size(), of_block);
  sums.particles = double(transfer.weights().placed_count());
  sums.outside = double(transfer.weights().outside_count());
  transfer.deposit<1>(volume_);
  const cfd::BlockFields& solid = transfer.work[0];
  for (std::size_t b = 0; b < mesh_.local.size(); ++b) {
    const cfd::Block& block = mesh_.local[b];
    // Before it becomes 1 - eps, which has no digits left for a single small particle.
    sums.solid_volume += cfd::sum_cells(block.layout, [&](std::ptrdiff_t c) {
      field[b][c] = 1 - solid[b][c];
      return solid[b][c] * block.volume[c];
    });
  }
  check(sums);
}

void VoidFraction::check(ExchangeSums& sums) const {
  std::string complaint;
  for (std::size_t b = 0; b < mesh_.local.size(); ++b) {
    const cfd::Block& block = mesh_.local[b];
    const double least = -cfd::max_cells(block.layout, -sums.void_fraction_min,
                                         [&](std::ptrdiff_t c) { return -field[b][c]; });
    // Also true for not-a-number.
    if (!(least >= sums.void_fraction_min) && !(least >= floor_))
      complaint = too_little_gas(b, least);
    sums.void_fraction_min = least;
  }
  throw_together<NumericalError>(mesh_.comm, complaint);
}

/// Names the cell of a block that has the void fraction `least`.
std::string VoidFraction::too_little_gas(std::size_t b, double least) const {
  const cfd::Block& block = mesh_.local[b];
  for (int k = 0; k < block.layout.cells[2]; ++k)
    for (int j = 0; j < block.layout.cells[1]; ++j)
      for (int i = 0; i < block.layout.cells[0]; ++i) {
        const std::ptrdiff_t c = block.layout.at(i, j, k);
        if (field[b][c] > least || std::isnan(field[b][c]) != std::isnan(least))
          continue;
        const Vec3 centre{block.centre[0][c], block.centre[1][c], block.centre[2][c]};
        return "coupling: void fraction " + text(field[b][c]) + " in cell (" + std::to_string(i) +
               ", " + std::to_string(j) + ", " + std::to_string(k) + ") of block " +
               std::to_string(block.id) + ", centre " + text(centre) +
               " m, is below void_fraction_floor = " + text(floor_) +
               "; use a wider smoothing (void_fraction = \"smoothed\", smoothing_width) or a "
               "coarser grid";
      }
  return {};
}

} // namespace granflux::coupling
