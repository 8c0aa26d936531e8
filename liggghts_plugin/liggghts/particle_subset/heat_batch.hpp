// SPDX-FileCopyrightText: 2026 The GranFlux developers
// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

#include "contact_batch.hpp"
#include "contact_heat.hpp"
#include "subset.hpp"

namespace granflux::particle_subset {

/// Forces alone: leaves no instruction in a kernel.
struct WithoutHeat {
  static constexpr bool acts = false;
  using Source = WithoutHeat;
};

/// The heat of a batch of contacts, beside its forces.
class HeatBatch {
public:
  static constexpr bool acts = true;
  using Source = HeatOfContacts;

  explicit HeatBatch(const HeatOfContacts& heat);
  HeatBatch(const HeatBatch&) = delete;
  HeatBatch& operator=(const HeatBatch&) = delete;

  /// Before the forces: the partners of pair k.
  void gather(int k, int i, int j, const int* type) {
    temperature_i_[k] = arrays_.temperature[i];
    temperature_j_[k] = arrays_.temperature[j];
    if (law_.types() > 1)
      set_constants(k, law_.pair(type[i], type[j]));
  }
  /// With the forces.
  void set(int k, const ContactForce& f) {
    pressing_[k] = f.pressing;
    overlap_[k] = f.overlap;
    reduced_radius_[k] = f.reduced_radius;
    sliding_[k] = f.heat.sliding;
    slider_force_[k] = f.heat.slider_force;
    slip_squared_[k] = f.heat.slip_squared;
    damping_[k] = f.heat.damping;
  }
  /// After the forces; details are added at once, of the particles that are `own`.
  void evaluate(const ContactBatch& batch, int count, Range own);

  [[nodiscard]] HeatRates& rates(int particle) const { return arrays_.rates[particle]; }
  void prefetch(int particle) const {
    __builtin_prefetch(arrays_.temperature + particle);
    __builtin_prefetch(arrays_.rates + particle, 1);
  }
  void add_to_i(HeatRates& to, int k) const {
    to.conduction += conduction_[k];
    to.made += made_i_[k];
  }
  void add_to_j(int j, int k) const {
    HeatRates& to = rates(j);
    to.conduction -= conduction_[k];
    to.made += made_j_[k];
  }

private:
  void set_constants(int k, const ContactHeat::PairConstants& pair) {
    per_radius_[k] = pair.conductance_per_radius;
    inverse_modulus_[k] = pair.inverse_modulus;
    overlap_ratio_[k] = pair.overlap_ratio;
    share_[k] = pair.share;
  }
  template <class Radius>
  void conduct(const Radius& radius, const ContactBatch& batch, int whole_groups);
  void share_out(int whole_groups);
  void add_details(const ContactBatch& batch, int count, Range own) const;

  using Column = ContactBatch::Column;
  const ContactHeat& law_;
  const HeatArrays arrays_;
  alignas(64) Column temperature_i_{}, temperature_j_{};
  alignas(64) Column per_radius_{}, inverse_modulus_{}, overlap_ratio_{}, share_{};
  alignas(64) Column pressing_{}, overlap_{}, reduced_radius_{};
  alignas(64) Column sliding_{}, slider_force_{}, slip_squared_{}, damping_{};
  alignas(64) Column conductance_{}, conduction_{}, made_i_{}, made_j_{};
};

} // namespace granflux::particle_subset
