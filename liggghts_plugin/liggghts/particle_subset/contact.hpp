// SPDX-FileCopyrightText: 2026 The GranFlux developers
// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

#include <cmath>

#include <granflux/cfd/vec3.hpp>

namespace granflux::particle_subset {

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
};

/// Powers that a contact turns into heat [W]. A kernel without heat leaves out what makes them.
struct Dissipation {
  double sliding = 0; ///< by the slider: its own displacement against its force
  /// By Eq. 8 of Amritkar, Deb, Tafti (2014), mu |F_n| |slip| while the contact slides: its parts.
  double slider_force = 0, slip_squared = 0; ///< N, 0 while it sticks; m2/s2
  double damping = 0;                        ///< by dashpots
  double rolling = 0;                        ///< by rolling friction

  [[nodiscard]] double sliding_by_speed() const { return slider_force * std::sqrt(slip_squared); }
};

/// On i, with the heat that it makes.
struct TangentialForce {
  Vec3 force;
  Dissipation heat;
};

/// Of rolling friction, with what it turns into heat.
struct RollingTorque {
  Vec3 on_j;         ///< the opposite on i
  double sliding;    ///< power of a slider in it [W]
  Vec3 against_spin; ///< the part whose work on the relative spin is heat
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

/// Power of the normal dashpot [W], with the speed at the middle of the half steps around it.
[[nodiscard]] inline double damping_power(const Contact& c, const NormalForce& normal, double dt) {
  const double speed = c.normal_speed + 0.5 * dt / c.reduced_mass * normal.force;
  return (normal.stiffness * c.overlap - normal.force) * speed;
}

} // namespace granflux::particle_subset
