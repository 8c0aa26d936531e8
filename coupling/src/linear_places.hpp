// SPDX-FileCopyrightText: 2026 The GranFlux developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>

#include <granflux/coupling/lattice_locate.hpp>
#include <granflux/coupling/window.hpp>

namespace granflux::coupling {

/// LatticeAxis::row<2>() along x, y, z of some points together: their coordinates, as they lie in
/// memory, are numbers that go through the same arithmetic on vector registers.
class LinearPlaces {
public:
  static constexpr std::size_t together = 16; ///< points: as many integers are in a register

  /// Of points whose lower cells are in `lower_cells`, part of the window that numbers them.
  /// Nothing where there are none, where cells along a direction are of several lengths, or one
  /// without a period.
  [[nodiscard]] static std::optional<LinearPlaces>
  make(const LatticeLocator& lattice, const Window& window, const Window& lower_cells) {
    const auto [nx, ny, nz] = window.extent();
    const std::array<int, 3> stride{1, nx, nx * ny}, extent = lower_cells.extent();
    if (*std::ranges::min_element(extent) <= 0) // there was no particle yet
      return std::nullopt;
    LinearPlaces all;
    for (std::size_t i = 0; i < numbers; ++i) {
      const std::size_t d = i % 3;
      const std::optional<LinearPlace>& axis = lattice.axis(int(d)).pairs();
      if (!axis)
        return std::nullopt;
      all.first_[i] = axis->first;
      all.last_[i] = axis->last;
      all.per_length_[i] = axis->per_length;
      all.least_[i] = axis->least;
      all.most_[i] = axis->most;
      all.lowest_[i] = lower_cells.lo[d];
      all.cells_[i] = unsigned(extent[d]);
      all.stride_[i] = unsigned(stride[d]);
    }
    return all;
  }

  /// From the coordinates of the points [m] the numbers of their lowest cells in the window, and
  /// of each point the shares of the upper cells along x, y, z. False where a point is outside the
  /// box or its lower cells are not among those above; the results count for nothing then.
  bool find(const double* x, std::uint32_t* cell, double* upper) const {
    unsigned part[numbers]; // of the number of a cell
    unsigned astray = 0;
#pragma omp simd reduction(| : astray)
    for (std::size_t i = 0; i < numbers; ++i) {
      const double xi = x[i];
      const double place = LinearPlace::place(xi, first_[i], per_length_[i], least_[i], most_[i]);
      const double lower = LinearPlace::lower(place, most_[i]);
      const auto in_window = unsigned(int(lower) - lowest_[i]);
      astray |= unsigned(!(xi >= first_[i])) | unsigned(!(xi <= last_[i])) |
                unsigned(in_window >= cells_[i]);
      part[i] = in_window * stride_[i];
      upper[i] = place - lower;
    }
    for (std::size_t i = 0; i < together; ++i)
      cell[i] = part[3 * i] + part[3 * i + 1] + part[3 * i + 2];
    return astray == 0;
  }

private:
  static constexpr std::size_t numbers = 3 * together;
  double first_[numbers], last_[numbers], per_length_[numbers], least_[numbers],
      most_[numbers]; ///< as LinearPlace
  int lowest_[numbers];
  unsigned cells_[numbers], stride_[numbers];
};

} // namespace granflux::coupling
