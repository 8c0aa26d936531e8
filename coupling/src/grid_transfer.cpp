// SPDX-FileCopyrightText: 2026 The GranFlux developers
// SPDX-License-Identifier: BSD-3-Clause
#include "grid_transfer.hpp"

#include <algorithm>
#include <cmath>
#include <mpi.h>
#include <type_traits>
#include <utility>
#include <variant>

#include <granflux/cfd/error.hpp>
#include <granflux/cfd/sweep.hpp>

#include "stopwatch.hpp"
#include "text_of_number.hpp"

namespace granflux::coupling {

GridTransfer::GridTransfer(const cfd::Mesh& mesh, const cfd::Halo& halo,
                           const CouplingOptions& options, CouplingTimes& times)
    : mesh_(mesh), halo_(halo), times_(times), locator_(make_locator(mesh)),
      kernel_(VoidFractionKernels::make("void_fraction", options.void_fraction)), exchange_(mesh),
      smoothing_width_(options.smoothing_width) {
  const bool serves_grid = std::visit(
      [](const auto& k, const auto& l) {
        return serves<std::remove_cvref_t<decltype(k)>, std::remove_cvref_t<decltype(l)>>;
      },
      kernel_, locator_);
  if (!serves_grid)
    throw ConfigError("coupling: void_fraction = \"" + options.void_fraction +
                      "\" needs a box grid; for grids fitted to a body there are centre, "
                      "divided and smoothed");
  if (!(smoothing_width_ >= 0 && std::isfinite(smoothing_width_)))
    throw ConfigError("coupling: smoothing_width = " + text(smoothing_width_) +
                      " must be a number of particle diameters, 0 or more");
  for (cfd::BlockFields& field : work)
    field = cfd::make_fields(mesh);
}

void GridTransfer::locate(const ParticleView& view) {
  const Stopwatch watch(times_.locate);
  weights_.build(kernel_, locator_, view.position, view.radius, view.coupled);
  exchange_.bind(weights_.window());
  choose_smoothing(view);
}

/// The width counts in diameters of the largest particle among the first that are coupled.
void GridTransfer::choose_smoothing(const ParticleView& view) {
  const bool smooths = std::visit([](const auto& k) { return k.smooths; }, kernel_);
  if (!smooths || smoothing_)
    return;
  if (smoothing_diameter_ == 0) {
    for (std::size_t p = 0; p < view.size(); ++p)
      if (placed(p))
        smoothing_diameter_ = std::max(smoothing_diameter_, 2 * view.radius[p]);
    MPI_Allreduce(MPI_IN_PLACE, &smoothing_diameter_, 1, MPI_DOUBLE, MPI_MAX, mesh_.comm);
  }
  if (smoothing_diameter_ > 0)
    smoothing_.emplace(mesh_, halo_, smoothing_width_ * smoothing_diameter_);
}

void GridTransfer::restore_smoothing_diameter(double diameter) {
  smoothing_diameter_ = diameter;
  smoothing_.reset();
}

/// S on the first K fields of `work`.
template <std::size_t K> void GridTransfer::smooth() {
  if (smoothing_)
    [&]<std::size_t... k>(std::index_sequence<k...>) {
      smoothing_->apply({&work[k]...});
    }
  (std::make_index_sequence<K>());
}

/// K numbers of each cell of the window: what it held before is lost.
template <std::size_t K> std::span<Values<K>> GridTransfer::window() {
  static_assert(sizeof(Values<K>) == K * sizeof(double));
  const std::size_t cells = weights_.window().size();
  if (window_values_.size() < K * cells)
    window_values_.resize(K * cells);
  return {reinterpret_cast<Values<K>*>(window_values_.data()), cells};
}

namespace {

/// Numbers of particles, K each.
template <std::size_t K> std::span<const Values<K>> rows(std::span<const double> numbers) {
  return {reinterpret_cast<const Values<K>*>(numbers.data()), numbers.size() / K};
}
template <std::size_t K> std::span<Values<K>> rows(std::span<double> numbers) {
  return {reinterpret_cast<Values<K>*>(numbers.data()), numbers.size() / K};
}

template <std::size_t K> std::span<double> flat(std::span<Values<K>> values) {
  return {reinterpret_cast<double*>(values.data()), K * values.size()};
}

} // namespace

template <std::size_t K> void GridTransfer::deposit(std::span<const double> values) {
  std::array<cfd::BlockFields*, K> fields;
  const std::span<Values<K>> sums = window<K>();
  {
    const Stopwatch watch(times_.deposit);
    weights_.deposit(rows<K>(values), sums);
    for (std::size_t k = 0; k < K; ++k) {
      fields[k] = &work[k];
      for (cfd::Field& field : work[k])
        field.fill(0);
    }
  }
  {
    const Stopwatch watch(times_.messages);
    exchange_.deposit(flat(sums), fields);
  }
  const Stopwatch watch(times_.deposit);
  for (std::size_t b = 0; b < mesh_.local.size(); ++b)
    cfd::for_cells(mesh_.local[b].layout, [&](std::ptrdiff_t c) {
      for (std::size_t k = 0; k < K; ++k)
        work[k][b][c] /= mesh_.local[b].volume[c];
    });
  smooth<K>();
}
template void GridTransfer::deposit<1>(std::span<const double>);
template void GridTransfer::deposit<2>(std::span<const double>);
template void GridTransfer::deposit<4>(std::span<const double>);
template void GridTransfer::deposit<6>(std::span<const double>);

/// In `work`.
template <std::size_t K>
std::vector<const cfd::Field*> GridTransfer::smoothed(std::span<const cfd::Field* const> fields) {
  for (std::size_t i = 0; i < fields.size(); ++i)
    work[i % K][i / K] = *fields[i];
  smooth<K>();
  std::vector<const cfd::Field*> result;
  for (std::size_t i = 0; i < fields.size(); ++i)
    result.push_back(&work[i % K][i / K]);
  return result;
}

template <std::size_t K>
void GridTransfer::sample(std::span<const cfd::Field* const> fields, std::span<double> values) {
  std::vector<const cfd::Field*> smooth_fields;
  if (smoothing_) {
    const Stopwatch watch(times_.sample);
    smooth_fields = smoothed<K>(fields);
    fields = smooth_fields;
  }
  const std::span<Values<K>> gas_values = window<K>();
  {
    const Stopwatch watch(times_.messages);
    exchange_.sample(fields, K, flat(gas_values));
  }
  const Stopwatch watch(times_.sample);
  weights_.sample(std::span<const Values<K>>(gas_values), rows<K>(values));
}
template void GridTransfer::sample<3>(std::span<const cfd::Field* const>, std::span<double>);
template void GridTransfer::sample<4>(std::span<const cfd::Field* const>, std::span<double>);
template void GridTransfer::sample<6>(std::span<const cfd::Field* const>, std::span<double>);
template void GridTransfer::sample<7>(std::span<const cfd::Field* const>, std::span<double>);

bool GridTransfer::any_placed() const {
  int any = weights_.placed_count() > 0;
  MPI_Allreduce(MPI_IN_PLACE, &any, 1, MPI_INT, MPI_MAX, mesh_.comm);
  return any != 0;
}

const GridExtent& GridTransfer::extent() const {
  return std::visit([](const auto& locator) -> const GridExtent& { return locator.extent(); },
                    locator_);
}

} // namespace granflux::coupling
