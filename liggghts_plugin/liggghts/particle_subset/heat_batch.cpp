// SPDX-FileCopyrightText: 2026 The GranFlux developers
// SPDX-License-Identifier: GPL-2.0-or-later

#include "heat_batch.hpp"

#include <algorithm>
#include <cmath>

namespace granflux::particle_subset {

HeatBatch::HeatBatch(const HeatOfContacts& heat) : law_(*heat.law), arrays_(heat.arrays) {
  for (int k = 0; k < ContactBatch::capacity; ++k)
    set_constants(k, law_.pair(1, 1));
}

template <class Radius>
[[gnu::flatten]] void HeatBatch::conduct(const Radius& radius, const ContactBatch& b,
                                         int whole_groups) {
#pragma GCC ivdep
  for (int k = 0; k < whole_groups; ++k) {
    coupling::ContactShape shape = coupling::shape_of_pair(
        b.radius_i[k], b.radius_j[k], overlap_ratio_[k] * overlap_[k], pressing_[k]);
    shape.reduced_radius = reduced_radius_[k];
    conductance_[k] = per_radius_[k] * radius(inverse_modulus_[k], shape);
    conduction_[k] = conductance_[k] * (temperature_j_[k] - temperature_i_[k]);
  }
}

/// The columns of sliding and damping become what the options count of them.
void HeatBatch::share_out(int whole_groups) {
  const FrictionHeat friction = law_.options().friction;
  if (friction == FrictionHeat::speed)
    for (int k = 0; k < whole_groups; ++k)
      sliding_[k] = slider_force_[k] * std::sqrt(slip_squared_[k]);
  else if (friction == FrictionHeat::off)
    std::fill_n(sliding_, whole_groups, 0.0);
  if (!law_.options().damping)
    std::fill_n(damping_, whole_groups, 0.0);
  for (int k = 0; k < whole_groups; ++k) {
    const double made = sliding_[k] + damping_[k];
    made_i_[k] = share_[k] * made;
    made_j_[k] = made - made_i_[k];
  }
}

void HeatBatch::evaluate(const ContactBatch& batch, int count, Range own) {
  constexpr int lanes = ContactBatch::lanes;
  const int whole_groups = (count + lanes - 1) / lanes * lanes;
  if (law_.options().radius)
    std::visit([&](const auto& radius) { conduct(radius, batch, whole_groups); },
               *law_.options().radius);
  share_out(whole_groups);
  if (arrays_.details)
    add_details(batch, count, own);
}

void HeatBatch::add_details(const ContactBatch& batch, int count, Range own) const {
  const auto add = [&](int particle, int k, double share) {
    if (!own.holds(particle))
      return;
    HeatDetails& to = arrays_.details[particle];
    to.friction += share * sliding_[k];
    to.damping += share * damping_[k];
    to.conductance += conductance_[k];
  };
  for (int k = 0; k < count; ++k) {
    add(batch.i[k], k, share_[k]);
    add(batch.j[k], k, 1 - share_[k]);
  }
}

} // namespace granflux::particle_subset
