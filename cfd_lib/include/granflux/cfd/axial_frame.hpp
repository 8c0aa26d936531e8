// SPDX-FileCopyrightText: 2026 The GranFlux developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <granflux/cfd/vec3.hpp>

namespace granflux::cfd {

/// Coordinates about an axis along x, y or z: p and q across it, s along it, right-handed. About z
/// they are x, y, z; about x: y, z, x; about y: z, x, y. Angles count from p towards q.
struct AxialFrame {
  int axis = 2;  ///< 0, 1, 2 for x, y, z
  Vec3 origin{}; ///< on the axis [m]

  [[nodiscard]] constexpr Vec3 point(double p, double q, double s) const {
    Vec3 x = origin;
    x[(axis + 1) % 3] += p;
    x[(axis + 2) % 3] += q;
    x[axis] += s;
    return x;
  }
  /// A vector along the axis.
  [[nodiscard]] constexpr Vec3 along(double length) const {
    Vec3 v;
    v[axis] = length;
    return v;
  }
};

} // namespace granflux::cfd
