// SPDX-FileCopyrightText: 2026 The GranFlux developers
// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

#include "subset.hpp"

namespace granflux::particle_subset {

/// Spheres whose motion is integrated. Arrays of a rank: vectors are 3 doubles a particle, packed.
struct Spheres {
  double *position, *velocity, *angular_velocity; // m, m/s, rad/s
  const double *force, *torque;                   // N, N m
  const double *radius, *mass;                    // m, kg
  const int* mask;                                // groups, one bit each
};

/// Half a time step of velocity Verlet for spheres, in the arithmetic of LIGGGHTS' fix nve/sphere
/// and in its order, so that the results agree to the last bit.
struct HalfKick {
  double half_step;         ///< half the time step, in units of force/(mass velocity)
  double half_step_inertia; ///< the same over I/(m r^2), 2/5 for a sphere
  double mass_factor;       ///< inertia of the displaced fluid: 1 without
  int group;                ///< bit of the group that moves
};

/// Velocities take the half step, the particles of `range` that are of the group.
void kick(const HalfKick& half, const Spheres& spheres, Range range);

/// The first half of a step: velocities take `halves` (1 or 2) half steps, then positions move on
/// by `step` times the velocity. Two half steps: the one that the last step was left to owe comes
/// first. Returns the largest squared velocity of those moved.
double kick_and_move(const HalfKick& half, int halves, double step, const Spheres& spheres,
                     Range range);

/// Adds mass times `acceleration` (3 numbers) to the force, for the particles of `range` that are
/// of the group.
void add_weight(const double* acceleration, int group, const double* mass, const int* mask,
                double* force, Range range);

} // namespace granflux::particle_subset
