// SPDX-FileCopyrightText: 2026 The GranFlux developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <granflux/cfd/vec3.hpp>

namespace granflux::coupling {

/// Sum that keeps its rounding errors beside it (two-sum: Knuth, The Art of Computer Programming
/// 2, 4.2.2), so that it is correct to about twice the digits of a double and thus the same, when
/// rounded, in any order and on any number of ranks and threads.
struct CompensatedSum {
  double high = 0, low = 0;

  CompensatedSum& operator+=(double x) & {
    const double sum = high + x;
    const double part = sum - high;
    low += (high - (sum - part)) + (x - part);
    high = sum;
    return *this;
  }
  CompensatedSum& operator+=(const CompensatedSum& o) & {
    *this += o.high;
    low += o.low;
    return *this;
  }
  friend CompensatedSum operator-(const CompensatedSum& a) { return {-a.high, -a.low}; }
  [[nodiscard]] double value() const { return high + low; }
};

struct CompensatedVec3 {
  CompensatedSum x, y, z;

  CompensatedVec3& operator+=(const Vec3& v) & {
    x += v.x, y += v.y, z += v.z;
    return *this;
  }
  CompensatedVec3& operator+=(const CompensatedVec3& v) & {
    x += v.x, y += v.y, z += v.z;
    return *this;
  }
  friend CompensatedVec3 operator-(const CompensatedVec3& a) { return {-a.x, -a.y, -a.z}; }
  [[nodiscard]] Vec3 value() const { return {x.value(), y.value(), z.value()}; }
};

} // namespace granflux::coupling
