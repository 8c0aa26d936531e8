// SPDX-FileCopyrightText: 2026 The GranFlux developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cmath>
#include <limits>

#include <granflux/cfd/vec3.hpp>

namespace granflux::coupling {

/// How far a particle may move with its shares in gas cells: within a ball, and along one direction
/// between two planes, for most of those that lie in two cells are stopped by the face between
/// them.
struct Room {
  static constexpr float unbounded = std::numeric_limits<float>::infinity();

  float ball = 0;                           ///< radius [m]; not above 0: it may not move
  std::array<float, 3> normal{};            ///< of length 1, or 0
  float low = -unbounded, high = unbounded; ///< along the normal [m]

  [[nodiscard]] bool holds(const Vec3& way) const {
    const double along = normal[0] * way.x + normal[1] * way.y + normal[2] * way.z;
    return (dot(way, way) < double(ball) * std::abs(double(ball))) & (low < along) & (along < high);
  }
};

} // namespace granflux::coupling
