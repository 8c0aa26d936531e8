// SPDX-FileCopyrightText: 2026 The GranFlux developers
// SPDX-License-Identifier: GPL-2.0-or-later

#include "half_kick_heat.hpp"

namespace granflux::particle_subset {

double half_kick_heat(const HalfKick& half, const Spheres& s, int i, const Resistance& r) {
  if (!(s.mask[i] & half.group))
    return 0;
  const auto at = [i](const double* rows) {
    return Vec3{rows[3 * i], rows[3 * i + 1], rows[3 * i + 2]};
  };
  const double linear = half.half_step / (s.mass[i] * half.mass_factor);
  const double angular = half.half_step_inertia / (s.radius[i] * s.radius[i] * s.mass[i]);
  return -linear * dot(r.force, at(s.force)) - angular * dot(r.torque, at(s.torque));
}

} // namespace granflux::particle_subset
