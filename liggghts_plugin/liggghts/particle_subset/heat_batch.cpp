// SPDX-FileCopyrightText: 2026 The GranFlux developers
// SPDX-License-Identifier: GPL-2.0-or-later

#include "heat_batch.hpp"

#include <algorithm>
#include <cmath>

namespace granflux::particle_subset {

HeatBatch::HeatBatch(const HeatOfContacts& heat) : law_(*heat.law), arrays_(heat.arrays) {
  friction_ = law_.options().friction == FrictionHeat::slider  ? sliding_
              : law_.options().friction == FrictionHeat::speed ? sliding_by_speed_
                                                               : none_;
  for (int k = 0; k < ContactBatch::capacity; ++k)
    set_constants(k, law_.pair(1, 1));
}

template <class Radius>
[[gnu::flatten]] void HeatBatch::conduct(const Radius& radius, const ContactBatch& b,
                                         int whole_groups) {
#pragma GCC ivdep
  for (int k = 0; k < whole_groups; ++k) {
    const double overlap = b.radius_i[k] + b.radius_j[k] - std::sqrt(b.distance_squared[k]);
    const coupling::ContactShape shape = coupling::shape_of_pair(
        b.radius_i[k], b.radius_j[k], overlap_ratio_[k] * overlap, pressing_[k]);
    conductance_[k] = per_radius_[k] * radius(inverse_modulus_[k], shape);
    conduction_[k] = conductance_[k] * (temperature_j_[k] - temperature_i_[k]);
  }
}

void HeatBatch::evaluate(const ContactBatch& batch, int count) {
  constexpr int lanes = ContactBatch::lanes;
  if (law_.options().radius)
    std::visit(
        [&](const auto& radius) { conduct(radius, batch, (count + lanes - 1) / lanes * lanes); },
        *law_.options().radius);
  if (!law_.options().damping)
    std::fill_n(damping_, count, 0.0);
}

} // namespace granflux::particle_subset
