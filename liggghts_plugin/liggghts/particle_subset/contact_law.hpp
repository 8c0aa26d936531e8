// SPDX-FileCopyrightText: 2026 The GranFlux developers
// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

#include <algorithm>
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
  ContactResistance damping, rubbing;
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
  static constexpr bool rubs = Tangential::rubs || Rolling::rubs;  ///< friction resists by speed
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
    if constexpr (history > 0)
      c.before = before(k, p, dt, c.reduced_radius, c.reduced_mass);

    NormalForce normal = Normal::force(k.normal, c);
    ContactForce f{.force = normal.force * c.normal,
                   .torque_i = {},
                   .torque_j = {},
                   .pressing = normal.force,
                   .overlap = c.overlap,
                   .reduced_radius = c.reduced_radius,
                   .heat = {},
                   .damping = {},
                   .rubbing = {}};
    const double dashpot = normal_dashpot(c, normal);
    f.damping.force = dashpot * c.normal;
    f.heat.damping = -dashpot * c.normal_speed;
    if constexpr (Cohesion::acts) {
      const double pull = Cohesion::force(k.cohesion, c);
      f.force += pull * c.normal;
      normal.force += k.cohesion.in_friction * pull;
    }
    if constexpr (Tangential::acts) {
      const TangentialForce tangential =
          Tangential::force(k.tangential, c, normal, dt, tangential_history);
      add_tangential(f, tangential);
      const Vec3 moment = cross(c.normal, tangential.force);
      f.torque_i = -arm_i * moment;
      f.torque_j = -arm_j * moment;
      turn(f.damping, cross(c.normal, tangential.dashpot), arm_i, arm_j);
      turn(f.rubbing, cross(c.normal, tangential.rubbing), arm_i, arm_j);
    }
    if constexpr (Rolling::acts) {
      const RollingTorque rolling = Rolling::torque(k.rolling, c, normal, dt, rolling_history);
      f.torque_i -= rolling.on_j;
      f.torque_j += rolling.on_j;
      f.rubbing.torque_i -= rolling.against_spin;
      f.rubbing.torque_j += rolling.against_spin;
      f.heat.rolling = rolling.sliding + dot(rolling.against_spin, c.relative_spin);
      f.heat.turning += rolling.turning;
    }
    return f;
  }

  /// What is left to become heat of two spheres that have parted in the last step, in which the
  /// contact remembered what is given: what its springs hold, less the work of their last forces
  /// [J]. 0 if they had parted before.
  static double left_at_parting(const Constants& k, const TouchingPair& p, double dt,
                                const Vec3& tangential_history, const Vec3& rolling_history) {
    const double reduced_radius = p.radius_i * p.radius_j / (p.radius_i + p.radius_j);
    const ContactBefore last =
        before(k, p, dt, reduced_radius, p.mass_i * p.mass_j / (p.mass_i + p.mass_j));
    double energy = 0;
    if (last.tangential_stiffness > 0) {
      if constexpr (has_tangential_history)
        energy +=
            Tangential::stored(last.tangential_stiffness, reduced_radius, tangential_history) -
            Tangential::last_work(last, tangential_history, dt);
      if constexpr (has_rolling_history)
        energy += Rolling::stored(last.tangential_stiffness, reduced_radius, rolling_history) -
                  Rolling::last_work(rolling_history, p.spin_i - p.spin_j, dt);
    }
    return energy;
  }

private:
  static ContactBefore before(const Constants& k, const TouchingPair& p, double dt,
                              double reduced_radius, double reduced_mass) {
    const Vec3 separation = p.separation - dt * p.velocity;
    const double distance = norm(separation), overlap = p.radius_i + p.radius_j - distance;
    const Vec3 normal = (1 / distance) * separation;
    Contact c{};
    c.overlap = std::max(overlap, 0.0);
    c.reduced_radius = reduced_radius;
    c.reduced_mass = reduced_mass;
    const double stiffness = Normal::force(k.normal, c).tangential_stiffness;
    const Vec3 surface_spin =
        (p.radius_i - 0.5 * overlap) * p.spin_i + (p.radius_j - 0.5 * overlap) * p.spin_j;
    const Vec3 slip = p.velocity - cross(surface_spin, normal);
    return {.tangential_stiffness = overlap > 0 ? stiffness : 0.0,
            .slip = slip - dot(slip, normal) * normal};
  }

  static void turn(ContactResistance& r, const Vec3& moment, double arm_i, double arm_j) {
    r.torque_i = -arm_i * moment;
    r.torque_j = -arm_j * moment;
  }
};

} // namespace granflux::particle_subset
