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

template <HeatMade made>
void HeatBatch<made>::set_constants(int k, const ContactHeat::PairConstants& pair) {
  per_radius_[k] = pair.conductance_per_radius;
  inverse_modulus_[k] = pair.inverse_modulus;
  overlap_ratio_[k] = pair.overlap_ratio;
  share_[k] = pair.share;
}

template <HeatMade made>
void HeatBatch<made>::set_constants(const ContactBatch& b, int count, const int* type) {
  for (int k = 0; k < count; ++k)
    set_constants(k, law_.pair(type[b.i[k]], type[b.j[k]]));
}

/// The columns of friction and damping become what the options count of them.
template <HeatMade made> void HeatBatch<made>::count_what_is_made(int whole_groups) {
  const FrictionHeat friction = law_.options().friction;
  if (friction == FrictionHeat::off)
    std::fill_n(friction_, whole_groups, 0.0);
  if constexpr (made == HeatMade::by_any) {
    if (friction == FrictionHeat::speed)
      for (int k = 0; k < whole_groups; ++k)
        friction_[k] = slider_force_[k] * std::sqrt(slip_squared_[k]) + rolling_[k];
    if (!law_.options().damping)
      std::fill_n(damping_, whole_groups, 0.0);
  }
}

/// What the pairs' columns of rates hold, to the particles. Without branches where all are own:
/// that half of the contacts slide would be guessed wrongly half of the time.
template <HeatMade made>
void HeatBatch<made>::give(double* to, const ContactBatch& b, int count, bool all_own,
                           Range own) const {
  if (all_own) {
    for (int k = 0; k < count; ++k) {
      to[b.i[k]] += rate_i_[k];
      to[b.j[k]] += rate_j_[k];
    }
    return;
  }
  for (int k = 0; k < count; ++k) {
    if (own.holds(b.i[k]))
      to[b.i[k]] += rate_i_[k];
    if (own.holds(b.j[k]))
      to[b.j[k]] += rate_j_[k];
  }
}

template <HeatMade made>
void HeatBatch<made>::keep(const Column& power, double* energy, const ContactBatch& batch,
                           int count, Range own) {
  for (int k = 0; k < count; ++k) {
    const double heat = arrays_.kept.dt * power[k];
    rate_i_[k] = share_[k] * heat;
    rate_j_[k] = heat - rate_i_[k];
  }
  give(energy, batch, count, all_are(own, batch, count), own);
}

template <HeatMade made>
void HeatBatch<made>::keep(const ContactBatch& batch, int count, Range own) {
  if (arrays_.kept.friction)
    keep(friction_, arrays_.kept.friction, batch, count, own);
  if constexpr (made == HeatMade::by_any)
    if (arrays_.kept.damping)
      keep(damping_, arrays_.kept.damping, batch, count, own);
}

template <HeatMade made>
template <class Radius>
[[gnu::flatten]] void HeatBatch<made>::exchange(const Radius& radius, const ContactBatch& b,
                                                int whole_groups) {
  const double part = arrays_.part_of_step;
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
    heat *= part;
    rate_i_[k] = conduction_[k] + share_[k] * heat;
    rate_j_[k] = heat - rate_i_[k];
  }
}

template <HeatMade made>
void HeatBatch<made>::add(const ContactBatch& batch, int count, Range own, const int* type) {
  constexpr int lanes = ContactBatch::lanes;
  const int whole_groups = (count + lanes - 1) / lanes * lanes;
  count_what_is_made(whole_groups);
  if (types_ > 1)
    set_constants(batch, count, type);
  if (arrays_.kept.now) {
    keep(batch, count, own);
    return;
  }
#pragma GCC ivdep
  for (int k = 0; k < count; ++k)
    warmer_[k] = arrays_.temperature[batch.j[k]] - arrays_.temperature[batch.i[k]];
  std::fill(warmer_ + count, warmer_ + whole_groups, 0.0);
  if (law_.options().radius)
    std::visit([&](const auto& radius) { exchange(radius, batch, whole_groups); },
               *law_.options().radius);
  else
    exchange(NoRadius{}, batch, whole_groups);
  hand_on(batch, count, own);
  if (arrays_.shown.wanted())
    show(batch, count, own);
}

template <HeatMade made>
void HeatBatch<made>::Resisting::add(const ContactBatch& b, int count, Range own,
                                     Resistance* sums) const {
  for (int k = 0; k < count; ++k) {
    const int i = b.i[k], j = b.j[k];
    if (own.holds(i)) {
      sums[i].force += force.at(k);
      sums[i].torque += torque_i.at(k);
    }
    if (own.holds(j)) {
      sums[j].force -= force.at(k);
      sums[j].torque += torque_j.at(k);
    }
  }
}

template <HeatMade made>
void HeatBatch<made>::add_left(int i, int j, const int* type, double power, Range own) {
  const double share = law_.pair(type[i], type[j]).share;
  if (own.holds(i))
    arrays_.add_made(i, share * power, 0, sums_);
  if (own.holds(j))
    arrays_.add_made(j, (1 - share) * power, 0, sums_);
}

template <HeatMade made>
void HeatBatch<made>::resist(const ContactBatch& b, int count, Range own) const {
  if (arrays_.resistances.damping)
    damper_.add(b, count, own, arrays_.resistances.damping);
  if (arrays_.resistances.rubbing)
    rubbing_.add(b, count, own, arrays_.resistances.rubbing);
}

/// To the particles, and to the sums.
template <HeatMade made>
void HeatBatch<made>::hand_on(const ContactBatch& b, int count, Range own) {
  const bool all_own = all_are(own, b, count);
  give(arrays_.rate, b, count, all_own, own);
  const double part = arrays_.part_of_step;
  double conduction = 0, friction = 0, damping = 0;
  if (all_own) { // what one conducts to another adds up to nothing
#pragma omp simd reduction(+ : friction, damping)
    for (int k = 0; k < count; ++k) {
      friction += friction_[k];
      if constexpr (made == HeatMade::by_any)
        damping += damping_[k];
    }
  } else {
#pragma omp simd reduction(+ : conduction, friction, damping)
    for (int k = 0; k < count; ++k) {
      const double own_i = own.holds(b.i[k]) ? 1 : 0, own_j = own.holds(b.j[k]) ? 1 : 0;
      const double share = own_i * share_[k] + own_j * (1 - share_[k]);
      conduction += (own_i - own_j) * conduction_[k];
      friction += share * friction_[k];
      if constexpr (made == HeatMade::by_any)
        damping += share * damping_[k];
    }
  }
  sums_.conduction += conduction;
  sums_.friction += part * friction;
  sums_.damping += part * damping;
}

template <HeatMade made>
void HeatBatch<made>::show(const ContactBatch& batch, int count, Range own) const {
  const double part = arrays_.part_of_step;
  const auto add_to = [&](int particle, int k, double share, double conduction) {
    if (!own.holds(particle))
      return;
    const double friction = part * share * friction_[k];
    double damping = 0;
    if constexpr (made == HeatMade::by_any)
      damping = part * share * damping_[k];
    ContactHeatRates& contacts = arrays_.shown.contacts[particle];
    contacts.conduction += conduction;
    contacts.made += friction + damping;
    HeatDetails& details = arrays_.shown.details[particle];
    details.friction += friction;
    details.damping += damping;
    details.conductance += conductance_[k];
  };
  for (int k = 0; k < count; ++k) {
    add_to(batch.i[k], k, share_[k], conduction_[k]);
    add_to(batch.j[k], k, 1 - share_[k], -conduction_[k]);
  }
}

template class HeatBatch<HeatMade::by_slider>;
template class HeatBatch<HeatMade::by_any>;

} // namespace granflux::particle_subset
