// SPDX-FileCopyrightText: 2026 The GranFlux developers
// SPDX-License-Identifier: GPL-2.0-or-later

#include "heat_batch.hpp"

#include <algorithm>
#include <cmath>

namespace granflux::particle_subset {

namespace {

/// Whether both particles of all pairs are own.
bool all_are(Range own, const ContactBatch& b, int count) {
  int strangers = 0;
#pragma omp simd reduction(+ : strangers)
  for (int k = 0; k < count; ++k)
    strangers += !own.holds(b.i[k]) | !own.holds(b.j[k]);
  return strangers == 0;
}

/// Where nothing is conducted.
struct NoRadius {
  double operator()(double, const coupling::ContactShape&) const { return 0; }
};

} // namespace

template <HeatMade made>
HeatBatch<made>::HeatBatch(const HeatOfContacts& heat)
    : law_(*heat.law), arrays_(heat.arrays), types_(law_.types()) {
  for (int k = 0; k < ContactBatch::capacity; ++k)
    set_constants(k, law_.pair(1, 1));
}

/// The columns of friction and damping become what the options count of them.
template <HeatMade made> void HeatBatch<made>::count_what_is_made(int whole_groups) {
  const FrictionHeat friction = law_.options().friction;
  if (friction == FrictionHeat::speed)
    for (int k = 0; k < whole_groups; ++k)
      friction_[k] = slider_force_[k] * std::sqrt(slip_squared_[k]) + rolling_[k];
  else if (friction == FrictionHeat::off)
    std::fill_n(friction_, whole_groups, 0.0);
  if (!law_.options().damping)
    std::fill_n(damping_, whole_groups, 0.0);
}

template <HeatMade made>
template <class Radius>
[[gnu::flatten]] void HeatBatch<made>::exchange(const Radius& radius, const ContactBatch& b,
                                                int whole_groups) {
#pragma GCC ivdep
  for (int k = 0; k < whole_groups; ++k) {
    coupling::ContactShape shape = coupling::shape_of_pair(
        b.radius_i[k], b.radius_j[k], overlap_ratio_[k] * overlap_[k], pressing_[k]);
    shape.reduced_radius = reduced_radius_[k];
    conductance_[k] = per_radius_[k] * radius(inverse_modulus_[k], shape);
    conduction_[k] = conductance_[k] * warmer_[k];
    double heat = friction_[k];
    if constexpr (made == HeatMade::by_any)
      heat += damping_[k];
    rate_i_[k] = conduction_[k] + share_[k] * heat;
    rate_j_[k] = heat - rate_i_[k];
  }
}

template <HeatMade made>
void HeatBatch<made>::evaluate(const ContactBatch& batch, int count, Range own) {
  constexpr int lanes = ContactBatch::lanes;
  const int whole_groups = (count + lanes - 1) / lanes * lanes;
  if constexpr (made == HeatMade::by_any)
    count_what_is_made(whole_groups);
  if (law_.options().radius)
    std::visit([&](const auto& radius) { exchange(radius, batch, whole_groups); },
               *law_.options().radius);
  else
    exchange(NoRadius{}, batch, whole_groups);
  sum_up(batch, count, own);
  if (arrays_.shown.wanted())
    show(batch, count, own);
}

template <HeatMade made> void HeatBatch<made>::sum_up(const ContactBatch& b, int count, Range own) {
  double conduction = 0, friction = 0, damping = 0;
  if (all_are(own, b, count)) { // what one conducts to another adds up to nothing
#pragma omp simd reduction(+ : friction, damping)
    for (int k = 0; k < count; ++k) {
      friction += friction_[k];
      if constexpr (made == HeatMade::by_any)
        damping += damping_[k];
    }
    sums_.friction += friction;
    sums_.damping += damping;
    return;
  }
#pragma omp simd reduction(+ : conduction, friction, damping)
  for (int k = 0; k < count; ++k) {
    const double own_i = own.holds(b.i[k]) ? 1 : 0, own_j = own.holds(b.j[k]) ? 1 : 0;
    const double share = own_i * share_[k] + own_j * (1 - share_[k]);
    conduction += (own_i - own_j) * conduction_[k];
    friction += share * friction_[k];
    if constexpr (made == HeatMade::by_any)
      damping += share * damping_[k];
  }
  sums_.conduction += conduction;
  sums_.friction += friction;
  sums_.damping += damping;
}

template <HeatMade made>
void HeatBatch<made>::show(const ContactBatch& batch, int count, Range own) const {
  const auto add = [&](int particle, int k, double share, double conduction) {
    if (!own.holds(particle))
      return;
    ContactHeatRates& contacts = arrays_.shown.contacts[particle];
    contacts.conduction += conduction;
    contacts.made += share * (friction_[k] + damping_[k]);
    HeatDetails& details = arrays_.shown.details[particle];
    details.friction += share * friction_[k];
    details.damping += share * damping_[k];
    details.conductance += conductance_[k];
  };
  for (int k = 0; k < count; ++k) {
    add(batch.i[k], k, share_[k], conduction_[k]);
    add(batch.j[k], k, 1 - share_[k], -conduction_[k]);
  }
}

template class HeatBatch<HeatMade::by_slider>;
template class HeatBatch<HeatMade::by_any>;

} // namespace granflux::particle_subset
