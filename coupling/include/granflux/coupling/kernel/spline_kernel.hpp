// SPDX-FileCopyrightText: 2026 The GranFlux developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>

#include <granflux/coupling/cell_row.hpp>
#include <granflux/coupling/kernel/kernel.hpp>

namespace granflux::coupling {

/// Shares that are products of B-splines over n cells along each direction of a lattice, of degree
/// n - 1: a linear field is sampled exactly and the deposit keeps the particle's centre of mass, on
/// stretched grids too (C. de Boor, A Practical Guide to Splines, 1978). Next to a wall the share
/// of cells beyond it goes to the first cell.
template <int n> struct SplineKernel {
  static constexpr int width = n;

  template <class Emit>
  void operator()(const LatticeLocator& lattice, const ParticlePlace& particle, Emit&& emit) const {
    const auto [low, others] = *cube(lattice, particle.centre);
    const auto x = CellRow<n>::all(others[0]), y = CellRow<n>::all(others[1]),
               z = CellRow<n>::all(others[2]);
    for (std::size_t k = 0; k < n; ++k)
      for (std::size_t j = 0; j < n; ++j)
        for (std::size_t i = 0; i < n; ++i)
          if (const double weight = x[i] * y[j] * z[k]; weight > 0)
            emit(cfd::Index3{low[0] + int(i), low[1] + int(j), low[2] + int(k)}, weight);
  }

  /// Nothing for a centre outside the grid.
  [[nodiscard]] std::optional<CellCube<n>> cube(const LatticeLocator& lattice,
                                                const Vec3& centre) const {
    const auto x = lattice.axis(0).template row<n>(centre.x),
               y = lattice.axis(1).template row<n>(centre.y),
               z = lattice.axis(2).template row<n>(centre.z);
    if (!x || !y || !z)
      return std::nullopt;
    return CellCube<n>{{x->lowest, y->lowest, z->lowest}, {x->others, y->others, z->others}};
  }
};

} // namespace granflux::coupling
