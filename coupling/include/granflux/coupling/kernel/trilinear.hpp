// SPDX-FileCopyrightText: 2026 The GranFlux developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>

#include <granflux/coupling/kernel/kernel.hpp>

namespace granflux::coupling {

/// Linear in each direction between the two nearest cell centres, so that a linear field is sampled
/// exactly and the deposit keeps the particle's centre of mass, on stretched grids too. Between a
/// wall and the first cell centre, the share of the cell beyond the wall goes to the first cell.
struct Trilinear {
  static constexpr std::string_view name = "trilinear";
  static constexpr bool smooths = false;

  template <class Emit>
  void operator()(const LatticeLocator& lattice, const ParticlePlace& particle, Emit&& emit) const {
    std::array<Pair, 3> pair;
    for (int d = 0; d < 3; ++d)
      pair[std::size_t(d)] =
          neighbours(lattice.axis(d), particle.centre[d], particle.cell[std::size_t(d)]);
    for (int k = 0; k < 2; ++k)
      for (int j = 0; j < 2; ++j)
        for (int i = 0; i < 2; ++i) {
          const double weight = pair[0].share(i) * pair[1].share(j) * pair[2].share(k);
          if (weight > 0)
            emit(cfd::Index3{pair[0].low + i, pair[1].low + j, pair[2].low + k}, weight);
        }
  }

private:
  /// Cells low and low + 1, and the share of the upper one.
  struct Pair {
    int low = 0;
    double upper = 0;
    [[nodiscard]] double share(int i) const { return i == 0 ? 1 - upper : upper; }
  };

  static Pair neighbours(const LatticeAxis& axis, double x, int cell) {
    const int low = x < axis.centre(cell) ? cell - 1 : cell;
    if (!axis.periodic() && (low < 0 || low + 1 >= axis.cells()))
      return {cell, 0};
    const double below = axis.centre(low), above = axis.centre(low + 1);
    return {low, (x - below) / (above - below)};
  }
};

} // namespace granflux::coupling
