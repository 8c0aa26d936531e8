// SPDX-FileCopyrightText: 2026 The GranFlux developers
// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

#include <granflux/cfd/vec3.hpp>

namespace granflux::particle_subset {

/// What all particles and ghosts have in common; 0: they differ in it, or nobody has looked.
struct Alike {
  int type = 0;
  double radius = 0, mass = 0; ///< both or none
};

/// Arrays of the host, borrowed: the particles of this rank first, then the ghosts.
struct Particles {
  int owned = 0; ///< of this rank
  int all = 0;   ///< with ghosts
  const Vec3* position = nullptr;
  const Vec3* velocity = nullptr;
  const Vec3* spin = nullptr; ///< angular velocity
  const double* radius = nullptr;
  const double* mass = nullptr;
  const int* type = nullptr; ///< from 1 on
  const int* tag = nullptr;  ///< the same for a particle and its ghosts
  const int* groups = nullptr;
  Alike alike;
  int frozen_group = 0;  ///< bit of the particles that count as of infinite mass, or 0
  Vec3* force = nullptr; ///< of owned particles: added to
  Vec3* torque = nullptr;

  /// m_i m_j / (m_i + m_j); the other's mass where one is frozen.
  [[nodiscard]] double reduced_mass(int i, int j) const {
    if (frozen_group && (groups[j] & frozen_group))
      return mass[i];
    if (frozen_group && (groups[i] & frozen_group))
      return mass[j];
    return mass[i] * mass[j] / (mass[i] + mass[j]);
  }
};

} // namespace granflux::particle_subset
