// SPDX-FileCopyrightText: 2026 The GranFlux developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <cstring>

#include <granflux/cfd/vec3.hpp>
#include <granflux/coupling/compensated_sum.hpp>

namespace granflux::coupling {

/// Particles that are dealt with together, on vector registers.
inline constexpr std::size_t particles_a_block = 64;

/// One number of each particle of a block.
struct alignas(64) Lanes {
  std::array<double, particles_a_block> of;
  double& operator[](std::size_t i) { return of[i]; }
  double operator[](std::size_t i) const { return of[i]; }
};

/// value(i) of each particle: on vector registers where `value` consists of plain arithmetic, roots
/// and choices between numbers. A block is always worked out whole, places without a particle too:
/// so a particle's number does not depend on its place.
template <class Value> [[nodiscard]] Lanes lanes(Value&& value) {
  Lanes result;
#pragma omp simd
  for (std::size_t i = 0; i < particles_a_block; ++i)
    result[i] = value(i);
  return result;
}

/// As CompensatedSum: eight sums side by side, which are added up in the end.
[[nodiscard]] inline CompensatedSum sum(const Lanes& x) {
  using Eight [[gnu::vector_size(8 * sizeof(double))]] = double;
  Eight high{}, low{};
  for (std::size_t i = 0; i < particles_a_block; i += 8) {
    Eight next;
    std::memcpy(&next, &x.of[i], sizeof next);
    const Eight more = high + next, part = more - high;
    low += (high - (more - part)) + (next - part);
    high = more;
  }
  CompensatedSum all;
  for (std::size_t i = 0; i < 8; ++i)
    all += CompensatedSum{high[i], low[i]};
  return all;
}

[[nodiscard]] inline double largest(const Lanes& x) {
  double most = x[0];
#pragma omp simd reduction(max : most)
  for (std::size_t i = 0; i < particles_a_block; ++i)
    most = x[i] > most ? x[i] : most;
  return most;
}

/// A vector of each particle of a block.
struct VectorLanes {
  Lanes x, y, z;
  void set(std::size_t i, const Vec3& v) { x[i] = v.x, y[i] = v.y, z[i] = v.z; }
  [[nodiscard]] Vec3 at(std::size_t i) const { return {x[i], y[i], z[i]}; }
  Lanes& operator[](int d) { return d == 0 ? x : d == 1 ? y : z; }
  const Lanes& operator[](int d) const { return d == 0 ? x : d == 1 ? y : z; }
  VectorLanes& operator*=(const Lanes& factor) & {
    for (Lanes* component : {&x, &y, &z})
      *component = lanes([&](std::size_t i) { return (*component)[i] * factor[i]; });
    return *this;
  }
  [[nodiscard]] CompensatedVec3 sum() const {
    return {coupling::sum(x), coupling::sum(y), coupling::sum(z)};
  }
  [[nodiscard]] CompensatedSum sum_of_norms() const {
    return coupling::sum(
        lanes([&](std::size_t i) { return std::sqrt(x[i] * x[i] + y[i] * y[i] + z[i] * z[i]); }));
  }
};

} // namespace granflux::coupling
