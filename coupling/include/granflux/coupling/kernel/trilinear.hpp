// SPDX-FileCopyrightText: 2026 The GranFlux developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>

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
    const auto [low, upper] = *corners(lattice, particle.centre);
    const auto share = [](double above, int i) { return i == 0 ? 1 - above : above; };
    for (int k = 0; k < 2; ++k)
      for (int j = 0; j < 2; ++j)
        for (int i = 0; i < 2; ++i) {
          const double weight = share(upper.x, i) * share(upper.y, j) * share(upper.z, k);
          if (weight > 0)
            emit(cfd::Index3{low[0] + i, low[1] + j, low[2] + k}, weight);
        }
  }

  /// Nothing for a centre outside the grid.
  [[nodiscard]] std::optional<TrilinearCorners> corners(const LatticeLocator& lattice,
                                                        const Vec3& centre) const {
    const auto x = lattice.axis(0).between(centre.x), y = lattice.axis(1).between(centre.y),
               z = lattice.axis(2).between(centre.z);
    if (!x || !y || !z)
      return std::nullopt;
    return TrilinearCorners{{x->lower, y->lower, z->lower},
                            {x->upper_share, y->upper_share, z->upper_share}};
  }
};

} // namespace granflux::coupling
