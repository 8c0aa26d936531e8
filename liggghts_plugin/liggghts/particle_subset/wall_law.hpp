// SPDX-FileCopyrightText: 2026 The GranFlux developers
// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

#include <algorithm>

#include "contact.hpp"
#include "material.hpp"

namespace granflux::particle_subset {

/// A sphere that touches a wall.
struct TouchedWall {
  Vec3 separation; ///< from the wall's nearest point to the centre
  Vec3 velocity;   ///< of the centre relative to the wall
  Vec3 spin;       ///< angular velocity
  double distance; ///< of the centre from the wall
  double radius, mass;
};

/// The laws of a contact with a wall: a sphere of infinite radius and mass that does not spin.
template <class Normal, class Tangential, class Rolling, class Cohesion> struct WallLaw {
  using NormalLaw = Normal;
  using TangentialLaw = Tangential;
  using RollingLaw = Rolling;
  static constexpr int history = Tangential::history + Rolling::history; ///< doubles a contact
  static constexpr int rolling_offset = Tangential::history;
  static constexpr bool rubs = Tangential::rubs || Rolling::rubs; ///< friction resists by speed
  static constexpr bool has_tangential_history = Tangential::history > 0;
  static constexpr bool has_rolling_history = Rolling::history > 0;

  struct Constants {
    [[no_unique_address]] typename Normal::Constants normal;
    [[no_unique_address]] typename Tangential::Constants tangential;
    [[no_unique_address]] typename Rolling::Constants rolling;
    [[no_unique_address]] typename Cohesion::Constants cohesion;
  };
  static Constants constants(const Material& m, int particle, int wall) {
    return {Normal::constants(m, particle, wall), Tangential::constants(m, particle, wall),
            Rolling::constants(m, particle, wall), Cohesion::constants(m, particle, wall)};
  }

  struct Force {
    Vec3 force, torque; ///< on the particle
    double pressing;    ///< normal force without cohesion [N]
    Dissipation heat;
    Resistance damping, rubbing; ///< on the particle
  };

  /// The histories are brought to the end of the step of `dt` seconds.
  static Force force(const Constants& k, const TouchedWall& w, double dt, Vec3& tangential_history,
                     Vec3& rolling_history) {
    const double inverse = 1 / w.distance;
    Contact c;
    c.normal = inverse * w.separation;
    c.distance = w.distance;
    c.overlap = w.radius - w.distance;
    c.normal_speed = dot(w.velocity, c.normal);
    c.radius_i = c.radius_j = c.reduced_radius = w.radius;
    c.reduced_mass = w.mass;
    const double arm = w.radius - 0.5 * c.overlap;
    // As LIGGGHTS has it: the spin of the surface, where between particles it is theirs.
    c.relative_spin = (arm * inverse) * w.spin;
    c.slip = w.velocity - c.normal_speed * c.normal - cross(c.relative_spin, w.separation);

    if constexpr (history > 0)
      c.before = before(k, w, dt);

    NormalForce normal = Normal::force(k.normal, c);
    Force f{.force = normal.force * c.normal,
            .torque = {},
            .pressing = normal.force,
            .heat = {},
            .damping = {},
            .rubbing = {}};
    const double dashpot = normal_dashpot(c, normal);
    f.damping.force = dashpot * c.normal;
    f.heat.damping = -dashpot * c.normal_speed;
    if constexpr (Cohesion::acts) {
      const double pull = Cohesion::force_of_wall(k.cohesion, c);
      f.force += pull * c.normal;
      normal.force += k.cohesion.in_friction * pull;
    }
    if constexpr (Tangential::acts) {
      const TangentialForce tangential =
          Tangential::force(k.tangential, c, normal, dt, tangential_history);
      add_tangential(f, tangential);
      f.torque = -arm * cross(c.normal, tangential.force);
      f.damping.torque = -arm * cross(c.normal, tangential.dashpot);
      f.rubbing.torque = -arm * cross(c.normal, tangential.rubbing);
    }
    if constexpr (Rolling::acts) {
      const RollingTorque rolling = Rolling::torque(k.rolling, c, normal, dt, rolling_history);
      f.torque -= rolling.on_j;
      f.rubbing.torque -= rolling.against_spin;
      // What the torque works on is the sphere's own spin.
      const double sliding = (w.distance / arm) * rolling.sliding;
      f.heat.rolling = sliding + dot(rolling.against_spin, w.spin);
      f.heat.turning += rolling.turning + rolling.sliding - sliding +
                        dot(rolling.spring, w.spin - c.relative_spin);
    }
    return f;
  }

  /// As ContactLaw::left_at_parting(); `w` is not touched any more.
  static double left_at_parting(const Constants& k, const TouchedWall& w, double dt,
                                const Vec3& tangential_history, const Vec3& rolling_history) {
    const ContactBefore last = before(k, w, dt);
    double energy = 0;
    if (last.tangential_stiffness > 0) {
      if constexpr (has_tangential_history)
        energy += Tangential::stored(last.tangential_stiffness, w.radius, tangential_history) -
                  Tangential::last_work(last, tangential_history, dt);
      if constexpr (has_rolling_history)
        energy += Rolling::stored(last.tangential_stiffness, w.radius, rolling_history) -
                  Rolling::last_work(rolling_history, w.spin, dt);
    }
    return energy;
  }

private:
  /// The wall is flat: the normal was the same.
  static ContactBefore before(const Constants& k, const TouchedWall& w, double dt) {
    const Vec3 normal = (1 / w.distance) * w.separation;
    const double speed = dot(w.velocity, normal);
    const double overlap = w.radius - w.distance + dt * speed;
    Contact c{};
    c.overlap = std::max(overlap, 0.0);
    c.reduced_radius = w.radius;
    c.reduced_mass = w.mass;
    const double stiffness = Normal::force(k.normal, c).tangential_stiffness;
    return {.tangential_stiffness = overlap > 0 ? stiffness : 0.0,
            .slip =
                w.velocity - speed * normal - cross((w.radius - 0.5 * overlap) * w.spin, normal)};
  }
};

} // namespace granflux::particle_subset
