// SPDX-FileCopyrightText: 2026 The GranFlux developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>

#include <granflux/coupling/kernel/kernel.hpp>

namespace granflux::coupling {

/// The cells lowest and lowest + 1 along x, y, z, and the shares of the upper ones.
struct TrilinearCorners {
  cfd::Index3 lowest;
  Vec3 upper;
};

/// Linear in each direction between the two nearest cell centres, so that a linear field is sampled
/// exactly and the deposit keeps the particle's centre of mass, on stretched grids too. Between a
/// wall and the first cell centre, the share of the cell beyond the wall goes to the first cell.
struct Trilinear {
  static constexpr std::string_view name = "trilinear";
  static constexpr bool smooths = false;

  template <class Emit>
  void operator()(const LatticeLocator& lattice, const ParticlePlace& particle, Emit&& emit) const {
    const auto [low, upper] = corners(lattice, particle.centre, particle.cell);
    const auto share = [](double above, int i) { return i == 0 ? 1 - above : above; };
    for (int k = 0; k < 2; ++k)
      for (int j = 0; j < 2; ++j)
        for (int i = 0; i < 2; ++i) {
          const double weight = share(upper.x, i) * share(upper.y, j) * share(upper.z, k);
          if (weight > 0)
            emit(cfd::Index3{low[0] + i, low[1] + j, low[2] + k}, weight);
        }
  }

  /// Along a direction of one cell without a period the upper one does not exist, and its share is
  /// 0; everywhere else both do.
  [[nodiscard]] TrilinearCorners corners(const LatticeLocator& lattice, const Vec3& centre,
                                         const cfd::Index3& cell) const {
    TrilinearCorners found{};
    for (int d = 0; d < 3; ++d) {
      const Pair pair = neighbours(lattice.axis(d), centre[d], cell[std::size_t(d)]);
      found.lowest[std::size_t(d)] = pair.low;
      found.upper[d] = pair.upper;
    }
    return found;
  }

private:
  struct Pair {
    int low = 0;
    double upper = 0;
  };

  static Pair neighbours(const LatticeAxis& axis, double x, int cell) {
    const int low = x < axis.centre(cell) ? cell - 1 : cell;
    if (!axis.periodic()) {
      if (low < 0)
        return {0, 0};
      if (low + 1 >= axis.cells())
        return low > 0 ? Pair{low - 1, 1} : Pair{0, 0};
    }
    const double below = axis.centre(low), above = axis.centre(low + 1);
    return {low, (x - below) / (above - below)};
  }
};

} // namespace granflux::coupling
