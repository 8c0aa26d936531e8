// SPDX-FileCopyrightText: 2026 The GranFlux developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>

#include <granflux/cfd/vec3.hpp>
#include <granflux/coupling/window.hpp>

namespace granflux::coupling {

/// The particles of a rank for which shares in gas cells are found.
struct ParticlesToPlace {
  std::span<const Vec3> position;        ///< m
  std::span<const double> radius;        ///< m
  std::span<const std::uint8_t> coupled; ///< 0: left out; empty: all take part

  [[nodiscard]] std::size_t size() const { return position.size(); }
  [[nodiscard]] bool takes_part(std::size_t p) const { return coupled.empty() || coupled[p] != 0; }
};

/// What came of it: of one thread, or of all.
struct Placing {
  std::size_t placed = 0;  ///< coupled and inside the grid
  std::size_t outside = 0; ///< meant to be coupled, but with the centre outside the grid
  Window window = nothing; ///< tight around the cells that get shares

  void include(const cfd::Index3& lo, const cfd::Index3& hi) {
    for (std::size_t d = 0; d < 3; ++d) {
      window.lo[d] = std::min(window.lo[d], lo[d]);
      window.hi[d] = std::max(window.hi[d], hi[d]);
    }
  }
  Placing& operator+=(const Placing& o) & {
    placed += o.placed;
    outside += o.outside;
    include(o.window.lo, o.window.hi);
    return *this;
  }

private:
  static constexpr int most = std::numeric_limits<int>::max();
  static constexpr Window nothing{{most, most, most}, {-most, -most, -most}};
};

/// First of the count items that thread t of n works on: consecutive runs, in the order of t.
inline std::size_t run_begin(std::size_t count, int t, int n) {
  return count * std::size_t(t) / std::size_t(n);
}

} // namespace granflux::coupling
