// SPDX-FileCopyrightText: 2026 The GranFlux developers
// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

#include <cmath>

#include <granflux/cfd/vec3.hpp>

namespace granflux::particle_subset {

/// A contact as it was placed a step ago: the velocities of this one have brought it here.
struct ContactBefore {
  double tangential_stiffness; ///< N/m; 0 if the two did not touch
  Vec3 slip;                   ///< of the surfaces by the velocities of now, tangential then
};

/// Two touching spheres i and j, seen from i, in consistent units.
struct Contact {
  Vec3 normal;         ///< unit vector from j to i
  double distance;     ///< of the centres
  double overlap;      ///< sum of the radii less the distance
  double normal_speed; ///< of i relative to j along the normal: negative while they approach
  Vec3 slip;           ///< velocity of i's surface relative to j's, tangential
  Vec3 relative_spin;  ///< angular velocity of i less that of j
  double radius_i, radius_j;
  double reduced_radius; ///< ri rj / (ri + rj)
  double reduced_mass;   ///< mi mj / (mi + mj); the other's mass where one is frozen
  ContactBefore before;
};

/// Force and torque against motion, whose work is heat: on one particle [N, N m].
struct Resistance {
  Vec3 force, torque;
};

/// The same of a contact.
struct ContactResistance {
  Vec3 force; ///< on i; the opposite on j
  Vec3 torque_i, torque_j;
};

/// Powers that a contact turns into heat [W], with the speeds before the half kick of its step:
/// what that adds follows from the resistances, once all forces on a particle are known. A kernel
/// without heat leaves out what makes them.
struct Dissipation {
  double sliding = 0; ///< by the slider: its own displacement against its force
  /// By Eq. 8 of Amritkar, Deb, Tafti (2014), mu |F_n| |slip| while the contact slides: its parts.
  double slider_force = 0, slip_squared = 0; ///< N, 0 while it sticks; m2/s2
  double damping = 0;                        ///< by dashpots
  double rolling = 0;                        ///< by rolling friction
  /// What springs lose, or gain, by steps of finite length: as the contact turns, and as stiffness
  /// changes with the overlap.
  double turning = 0;

  [[nodiscard]] double sliding_by_speed() const { return slider_force * std::sqrt(slip_squared); }
};

/// On i, with the heat that it makes.
struct TangentialForce {
  Vec3 force;
  Dissipation heat;
  Vec3 dashpot = {}, rubbing = {}; ///< the parts that resist the slip
};

/// Adds a tangential force, with what it resists and makes of heat, to what a normal law has begun
/// of a contact between particles or at a wall.
template <class ForceOfContact>
void add_tangential(ForceOfContact& f, const TangentialForce& tangential) {
  const double by_normal_dashpot = f.heat.damping;
  f.force += tangential.force;
  f.damping.force += tangential.dashpot;
  f.rubbing.force = tangential.rubbing;
  f.heat = tangential.heat;
  f.heat.damping += by_normal_dashpot;
}

/// Of rolling friction, with what it turns into heat.
struct RollingTorque {
  Vec3 on_j;              ///< the opposite on i
  double sliding = 0;     ///< power of a slider in it [W]
  Vec3 against_spin = {}; ///< the part whose work on the relative spin is heat
  Vec3 spring = {};       ///< the mean over the step of the part that a spring makes
  double turning = 0;     ///< Dissipation::turning of that spring
};

/// Slip at the middle of the two half steps of velocity around a force: the force changes it in
/// between. A tangential force moves surfaces of spheres 7/2 times as easily as their centres.
[[nodiscard]] inline Vec3 mean_slip(const Contact& c, const Vec3& tangential_force, double dt) {
  return c.slip + (0.5 * 3.5 * dt / c.reduced_mass) * tangential_force;
}

/// What a normal law hands on to the laws that follow it.
struct NormalForce {
  double force;     ///< on i along the normal; negative if it pulls
  double stiffness; ///< force = stiffness * overlap + damping
  double tangential_stiffness;
  double tangential_damping; ///< 0 where the script switches it off
};

/// Of the normal dashpot, on i along the normal [N].
[[nodiscard]] inline double normal_dashpot(const Contact& c, const NormalForce& normal) {
  return normal.force - normal.stiffness * c.overlap;
}

} // namespace granflux::particle_subset
