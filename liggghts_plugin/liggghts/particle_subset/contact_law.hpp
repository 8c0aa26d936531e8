// SPDX-FileCopyrightText: 2026 The GranFlux developers
// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

#include <cmath>

#include "contact.hpp"
#include "material.hpp"

namespace granflux::particle_subset {

/// Two spheres as they are found: what the law of a contact starts from.
struct TouchingPair {
  Vec3 separation; ///< centre of i less centre of j
  double distance_squared;
  Vec3 velocity;       ///< of i less that of j
  Vec3 spin_i, spin_j; ///< angular velocities
  double radius_i, radius_j;
  double mass_i, mass_j;
};

/// Forces and torques on i and on j = its opposite, apart from the torques.
struct ContactForce {
  Vec3 force; ///< on i; the opposite on j
  Vec3 torque_i, torque_j;
  // What heat starts from.
  double pressing; ///< normal force without cohesion [N]
  double overlap, reduced_radius;
  Dissipation heat;
};

/// One choice of laws, put together by the compiler: an effect that is off leaves no instruction.
template <class Normal, class Tangential, class Rolling, class Cohesion> struct ContactLaw {
  using NormalLaw = Normal;
  using TangentialLaw = Tangential;
  using RollingLaw = Rolling;
  static constexpr int history = Tangential::history + Rolling::history; ///< doubles a contact
  static constexpr bool has_tangential_history = Tangential::history > 0;
  static constexpr bool has_rolling_history = Rolling::history > 0;
  static constexpr int rolling_offset = Tangential::history;
  static constexpr bool rolls = Rolling::acts;
  static constexpr bool turns = Tangential::acts || Rolling::acts; ///< there are torques
  /// The host's marks of the laws that have acted on a pair.
  static constexpr int touched =
      1 | (Cohesion::acts ? 2 : 0) | (Tangential::acts ? 4 : 0) | (has_rolling_history ? 8 : 0);

  /// Of one pair of types.
  struct Constants {
    [[no_unique_address]] typename Normal::Constants normal;
    [[no_unique_address]] typename Tangential::Constants tangential;
    [[no_unique_address]] typename Rolling::Constants rolling;
    [[no_unique_address]] typename Cohesion::Constants cohesion;
  };

  static Constants constants(const Material& m, int a, int b) {
    return {Normal::constants(m, a, b), Tangential::constants(m, a, b), Rolling::constants(m, a, b),
            Cohesion::constants(m, a, b)};
  }

  /// The history is brought to the end of the step of `dt` seconds.
  static ContactForce force(const Constants& k, const TouchingPair& p, double dt,
                            Vec3& tangential_history, Vec3& rolling_history) {
    const double distance = std::sqrt(p.distance_squared);
    const double inverse = 1 / distance;
    Contact c;
    c.normal = inverse * p.separation;
    c.distance = distance;
    c.overlap = p.radius_i + p.radius_j - distance;
    c.normal_speed = dot(p.velocity, c.normal);
    c.radius_i = p.radius_i;
    c.radius_j = p.radius_j;
    c.reduced_radius = p.radius_i * p.radius_j / (p.radius_i + p.radius_j);
    c.reduced_mass = p.mass_i * p.mass_j / (p.mass_i + p.mass_j);
    // Distances from the centres to the middle of the overlap.
    const double arm_i = p.radius_i - 0.5 * c.overlap;
    const double arm_j = p.radius_j - 0.5 * c.overlap;
    if constexpr (Tangential::acts) {
      const Vec3 surface_spin = inverse * (arm_i * p.spin_i + arm_j * p.spin_j);
      c.slip = p.velocity - c.normal_speed * c.normal - cross(surface_spin, p.separation);
    }
    if constexpr (Rolling::acts)
      c.relative_spin = p.spin_i - p.spin_j;

    NormalForce normal = Normal::force(k.normal, c);
    ContactForce f{.force = normal.force * c.normal,
                   .torque_i = {},
                   .torque_j = {},
                   .pressing = normal.force,
                   .overlap = c.overlap,
                   .reduced_radius = c.reduced_radius,
                   .heat = {}};
    f.heat.damping = damping_power(c, normal, dt);
    if constexpr (Cohesion::acts) {
      const double pull = Cohesion::force(k.cohesion, c);
      f.force += pull * c.normal;
      normal.force += k.cohesion.in_friction * pull;
    }
    if constexpr (Tangential::acts) {
      const auto [tangential, heat] =
          Tangential::force(k.tangential, c, normal, dt, tangential_history);
      f.force += tangential;
      f.heat.sliding = heat.sliding;
      f.heat.slider_force = heat.slider_force;
      f.heat.slip_squared = heat.slip_squared;
      f.heat.damping += heat.damping;
      const Vec3 moment = cross(c.normal, tangential);
      f.torque_i = -arm_i * moment;
      f.torque_j = -arm_j * moment;
    }
    if constexpr (Rolling::acts) {
      const RollingTorque rolling = Rolling::torque(k.rolling, c, normal, dt, rolling_history);
      f.torque_i -= rolling.on_j;
      f.torque_j += rolling.on_j;
      // At the middle of the two half steps of spin around the torques.
      const Vec3 turned = (1.25 * dt) * (1 / (p.mass_i * p.radius_i * p.radius_i) * f.torque_i -
                                         1 / (p.mass_j * p.radius_j * p.radius_j) * f.torque_j);
      f.heat.rolling = rolling.sliding + dot(rolling.against_spin, c.relative_spin + turned);
    }
    return f;
  }
};

} // namespace granflux::particle_subset
