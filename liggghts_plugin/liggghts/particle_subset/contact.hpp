// SPDX-FileCopyrightText: 2026 The GranFlux developers
// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

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

/// What a normal law hands on to the laws that follow it.
struct NormalForce {
  double force;     ///< on i along the normal; negative if it pulls
  double stiffness; ///< force = stiffness * overlap + damping
  double tangential_stiffness;
  double tangential_damping; ///< 0 where the script switches it off
};

} // namespace granflux::particle_subset
