// SPDX-FileCopyrightText: 2026 The GranFlux developers
// SPDX-License-Identifier: BSD-3-Clause
#include <granflux/coupling/smoothing.hpp>

#include <algorithm>
#include <cmath>
#include <string>

#include <granflux/cfd/error.hpp>

namespace granflux::coupling {

namespace {

/// Volume flow per second through the low faces of a block for D = 1 m2/s: the conductance, and 0
/// at boundaries and where a periodic cell is its own neighbour.
cfd::VectorField conductances(const cfd::Block& block, const cfd::BlockInfo& info) {
  const cfd::Layout& layout = block.layout;
  cfd::VectorField rate{block.conductance[0], block.conductance[1], block.conductance[2]};
  for (const cfd::Patch& patch : info.patches) {
    const auto d = std::size_t(patch.side.direction);
    for (int k = patch.cells.lo[2]; k < patch.cells.hi[2]; ++k)
      for (int j = patch.cells.lo[1]; j < patch.cells.hi[1]; ++j)
        for (int i = patch.cells.lo[0]; i < patch.cells.hi[0]; ++i) {
          cfd::Index3 beyond{i, j, k};
          beyond[d] += patch.side.high ? 1 : -1;
          const bool itself = patch.link && patch.link->block == block.id &&
                              patch.link->donor(beyond) == cfd::Index3{i, j, k};
          if (!patch.link || itself)
            rate[d][layout.at(i, j, k) + (patch.side.high ? layout.stride[d] : 0)] = 0;
        }
  }
  return rate;
}

/// Largest share of its content that a cell of the block swaps per second for D = 1 m2/s.
double largest_rate(const cfd::Block& block, const cfd::VectorField& rate) {
  const cfd::Layout& layout = block.layout;
  double largest = 0;
  for (int k = 0; k < layout.cells[2]; ++k)
    for (int j = 0; j < layout.cells[1]; ++j)
      for (int i = 0; i < layout.cells[0]; ++i) {
        const auto c = layout.at(i, j, k);
        double sum = 0;
        for (std::size_t d = 0; d < 3; ++d)
          sum += rate[d][c] + rate[d][c + layout.stride[d]];
        largest = std::max(largest, sum / block.volume[c]);
      }
  return largest;
}

/// next = f after one sub-step.
void substep(const cfd::Block& block, const cfd::VectorField& exchange, const cfd::Field& f,
             cfd::Field& next) {
  const cfd::Layout& layout = block.layout;
  const auto [si, sj, sk] = layout.stride;
#pragma omp parallel for collapse(2) schedule(static)
  for (int k = 0; k < layout.cells[2]; ++k)
    for (int j = 0; j < layout.cells[1]; ++j) {
      const auto row = layout.at(0, j, k);
      for (auto c = row; c < row + layout.cells[0]; ++c)
        next[c] = f[c] +
                  (exchange[0][c] * (f[c - si] - f[c]) + exchange[0][c + si] * (f[c + si] - f[c]) +
                   exchange[1][c] * (f[c - sj] - f[c]) + exchange[1][c + sj] * (f[c + sj] - f[c]) +
                   exchange[2][c] * (f[c - sk] - f[c]) + exchange[2][c + sk] * (f[c + sk] - f[c])) /
                      block.volume[c];
    }
}

} // namespace

Smoothing::Smoothing(const cfd::Mesh& mesh, const cfd::Halo& halo, double width)
    : mesh_(mesh), halo_(halo) {
  if (!(width >= 0) || !std::isfinite(width))
    throw ConfigError("smoothing width: must be a length >= 0, not " + std::to_string(width));
  if (width == 0)
    return;
  double fastest = 0;
  for (const cfd::Block& block : mesh.local) {
    exchange_.push_back(conductances(block, mesh.info(block)));
    fastest = std::max(fastest, largest_rate(block, exchange_.back()));
  }
  MPI_Allreduce(MPI_IN_PLACE, &fastest, 1, MPI_DOUBLE, MPI_MAX, mesh.comm);

  // With at most half of a cell swapped a sub-step, no sub-step's operator has an eigenvalue below
  // zero: what is smooth stays in phase.
  constexpr double most_swapped = 0.5;
  const double diffusion_time = width * width / 4; // D T
  const double substeps = std::ceil(diffusion_time * fastest / most_swapped);
  if (substeps > 1e6)
    throw ConfigError("smoothing width: " + std::to_string(width) +
                      " m is too wide for the smallest cell of the grid: it takes " +
                      std::to_string(substeps) + " sub-steps, and 1e6 are allowed");
  substeps_ = int(substeps);
  for (auto& block : exchange_)
    for (auto& faces : block)
      for (std::size_t c = 0; c < faces.size(); ++c)
        faces.data()[c] *= diffusion_time / std::max(substeps_, 1);
}

void Smoothing::apply(std::initializer_list<cfd::BlockFields*> fields) {
  if (substeps_ == 0)
    return;
  while (next_.size() < fields.size())
    next_.push_back(cfd::make_fields(mesh_));
  for (int step = 0; step < substeps_; ++step) {
    halo_.exchange(fields);
    auto next = next_.begin();
    for (cfd::BlockFields* f : fields) {
      for (std::size_t b = 0; b < mesh_.local.size(); ++b)
        substep(mesh_.local[b], exchange_[b], (*f)[b], (*next)[b]);
      std::swap(*f, *next++);
    }
  }
}

} // namespace granflux::coupling
