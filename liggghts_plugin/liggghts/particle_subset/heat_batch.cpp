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

/// What the particles of a batch add to: of what is kept, friction first.
double* target(const HeatArrays& arrays) {
  const KeptHeat& kept = arrays.kept;
  return !kept.now ? arrays.rate : kept.friction ? kept.friction : kept.damping;
}

} // namespace

template <HeatMade made>
HeatBatch<made>::HeatBatch(const HeatOfContacts& heat)
    : law_(*heat.law), arrays_(heat.arrays), to_(target(arrays_)),
      conducts_(law_.options().radius && !arrays_.kept.now),
      looked_at_(conducts_ ? arrays_.temperature : to_) {}

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

template <HeatMade made>
void HeatBatch<made>::look_at_temperatures(const ContactBatch& b, int count) {
  const double* const temperature = arrays_.temperature;
  for (int k = 0; k < count; ++k)
    warmer_[k] = temperature[b.j[k]] - temperature[b.i[k]];
}

/// Of a power, what it comes to in the time step.
template <HeatMade made> void HeatBatch<made>::share_out(const Column& power, int count) {
  for (int k = 0; k < count; ++k) {
    const double heat = arrays_.kept.dt * power[k];
    of_i_[k] = share_[k] * heat;
    of_j_[k] = heat - of_i_[k];
  }
}

template <HeatMade made> void HeatBatch<made>::keep(const ContactBatch& b, int count, Range own) {
  if constexpr (made == HeatMade::by_any)
    if (double* const energy = arrays_.kept.damping) {
      share_out(damping_, count);
      if (energy == to_)
        return;
      for (int k = 0; k < count; ++k) {
        if (own.holds(b.i[k]))
          energy[b.i[k]] += of_i_[k];
        if (own.holds(b.j[k]))
          energy[b.j[k]] += of_j_[k];
      }
    }
  share_out(friction_, count);
}

/// Sums over all pairs, as if all particles were own: what one conducts to another adds up to
/// nothing then.
template <HeatMade made>
template <class Radius>
[[gnu::flatten]] void HeatBatch<made>::exchange(const Radius& radius, const ContactBatch& b,
                                                int whole_groups) {
  const double part = arrays_.part_of_step;
  double friction = 0, damping = 0;
#pragma omp simd reduction(+ : friction, damping)
  for (int k = 0; k < whole_groups; ++k) {
    coupling::ContactShape shape = coupling::shape_of_pair(
        b.radius_i[k], b.radius_j[k], overlap_ratio_[k] * overlap_[k], pressing_[k]);
    shape.reduced_radius = reduced_radius_[k];
    conductance_[k] = per_radius_[k] * radius(inverse_modulus_[k], shape);
    conduction_[k] = conductance_[k] * warmer_[k];
    double heat = friction_[k];
    friction += friction_[k];
    if constexpr (made == HeatMade::by_any) {
      heat += damping_[k];
      damping += damping_[k];
    }
    heat *= part;
    of_i_[k] = conduction_[k] + share_[k] * heat;
    of_j_[k] = heat - of_i_[k];
  }
  sums_.friction += part * friction;
  sums_.damping += part * damping;
}

/// What other threads' or ranks' particles get is taken off the sums: they count it.
template <HeatMade made>
void HeatBatch<made>::take_off_others(const ContactBatch& b, int count, Range own) {
  const double part = arrays_.part_of_step;
  double conduction = 0, friction = 0, damping = 0;
#pragma omp simd reduction(+ : conduction, friction, damping)
  for (int k = 0; k < count; ++k) {
    const double own_i = own.holds(b.i[k]) ? 1 : 0, own_j = own.holds(b.j[k]) ? 1 : 0;
    const double others = (1 - own_i) * share_[k] + (1 - own_j) * (1 - share_[k]);
    conduction += (own_i - own_j) * conduction_[k];
    friction -= others * friction_[k];
    if constexpr (made == HeatMade::by_any)
      damping -= others * damping_[k];
  }
  sums_.conduction += conduction;
  sums_.friction += part * friction;
  sums_.damping += part * damping;
}

template <HeatMade made>
void HeatBatch<made>::add(const ContactBatch& batch, int count, Range own) {
  const int whole_groups = ContactBatch::whole_groups(count);
  count_what_is_made(whole_groups);
  if (arrays_.kept.now) {
    keep(batch, count, own);
    return;
  }
  if (conducts_)
    look_at_temperatures(batch, count);
  // Lanes without a pair of their own.
  std::fill(friction_ + count, friction_ + whole_groups, 0.0);
  if constexpr (made == HeatMade::by_any)
    std::fill(damping_ + count, damping_ + whole_groups, 0.0);
  if (law_.options().radius)
    std::visit([&](const auto& radius) { exchange(radius, batch, whole_groups); },
               *law_.options().radius);
  else
    exchange(NoRadius{}, batch, whole_groups);
  if (!all_are(own, batch, count))
    take_off_others(batch, count, own);
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

template <HeatMade made>
void HeatBatch<made>::show(const ContactBatch& batch, int count, Range own) const {
  for (int k = 0; k < count; ++k) { // seldom looked at: they come from far
    __builtin_prefetch(arrays_.shown.contacts + batch.j[k], 1);
    __builtin_prefetch(arrays_.shown.details + batch.j[k], 1);
  }
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
