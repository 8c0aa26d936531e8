// SPDX-FileCopyrightText: 2026 The GranFlux developers
// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

#include "contact.hpp"

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
    energy += Law::TangentialLaw::stored(stiffness, reduced_radius, history);
  if constexpr (Law::has_rolling_history)
    energy += Law::RollingLaw::stored(stiffness, reduced_radius, history + Law::rolling_offset);
  return energy;
}

} // namespace granflux::particle_subset
