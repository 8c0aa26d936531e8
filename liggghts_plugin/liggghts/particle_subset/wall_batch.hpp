// SPDX-FileCopyrightText: 2026 The GranFlux developers
// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

#include "contact_batch.hpp"
#include "wall_law.hpp"

namespace granflux::particle_subset {

/// Touches of one wall side by side, as ContactBatch has those of particles.
struct WallBatch {
  static constexpr int capacity = ContactBatch::capacity;
  using Column = ContactBatch::Column;
  using Vectors = ContactBatch::Vectors;

  Vectors separation, velocity, spin;
  alignas(64) Column distance, radius, mass;
  Vectors tangential_history, rolling_history;
  Vectors force, torque;

  [[nodiscard]] TouchedWall touched(int k) const {
    return {separation.at(k), velocity.at(k), spin.at(k), distance[k], radius[k], mass[k]};
  }
  void set(int k, const TouchedWall& w) {
    separation.set(k, w.separation);
    velocity.set(k, w.velocity);
    spin.set(k, w.spin);
    distance[k] = w.distance;
    radius[k] = w.radius;
    mass[k] = w.mass;
  }
};

/// As that of ContactBatch. `made` takes what the touches make of heat, if any.
template <class Law, bool one_material, class Made>
[[gnu::flatten]] void evaluate(WallBatch& b, int count,
                               const BatchConstants<Law, one_material>& constants, double dt,
                               Made& made) {
  const int whole = ContactBatch::whole_groups(count);
#pragma GCC ivdep
  for (int k = 0; k < whole; ++k) {
    Vec3 tangential = b.tangential_history.at(k), rolling = b.rolling_history.at(k);
    const auto f = Law::force(constants.at(k), b.touched(k), dt, tangential, rolling);
    b.force.set(k, f.force);
    b.torque.set(k, f.torque);
    if constexpr (Law::has_tangential_history)
      b.tangential_history.set(k, tangential);
    if constexpr (Law::has_rolling_history)
      b.rolling_history.set(k, rolling);
    made.set(k, f);
  }
}

} // namespace granflux::particle_subset
