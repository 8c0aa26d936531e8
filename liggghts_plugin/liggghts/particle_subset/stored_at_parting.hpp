// SPDX-FileCopyrightText: 2026 The GranFlux developers
// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

#include "contact_law.hpp"
#include "history_of_law.hpp"
#include "particles.hpp"

namespace granflux::particle_subset {

/// What the springs of a contact hold when it ends, at no overlap [J]. `history`: of that contact.
template <class Law>
[[nodiscard]] double stored_at_parting(const typename Law::Constants& k, double reduced_radius,
                                       double reduced_mass, const double* history) {
  Contact c{};
  c.reduced_radius = reduced_radius;
  c.reduced_mass = reduced_mass;
  const double stiffness = Law::NormalLaw::force(k.normal, c).tangential_stiffness;
  double energy = 0;
  if constexpr (Law::has_tangential_history)
    energy +=
        Law::TangentialLaw::stored(stiffness, reduced_radius, tangential_history<Law>(history));
  if constexpr (Law::has_rolling_history)
    energy += Law::RollingLaw::stored(stiffness, reduced_radius, rolling_history<Law>(history));
  return energy;
}

/// Law::left_at_parting() of i and j as they are placed now.
template <class Law>
[[nodiscard]] double left_at_parting(const typename Law::Constants& k, const Particles& p, int i,
                                     int j, double dt, const double* history) {
  const Vec3 separation = p.position[i] - p.position[j];
  const double mass = 2 * p.reduced_mass(i, j); // of both alike
  return Law::left_at_parting(k,
                              {.separation = separation,
                               .distance_squared = dot(separation, separation),
                               .velocity = p.velocity[i] - p.velocity[j],
                               .spin_i = p.spin[i],
                               .spin_j = p.spin[j],
                               .radius_i = p.radius[i],
                               .radius_j = p.radius[j],
                               .mass_i = mass,
                               .mass_j = mass},
                              dt, tangential_history<Law>(history), rolling_history<Law>(history));
}

} // namespace granflux::particle_subset
