// SPDX-FileCopyrightText: 2026 The GranFlux developers
// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

#include <omp.h>

#include "contact_batch.hpp"
#include "contact_heat.hpp"
#include "subset.hpp"

namespace granflux::particle_subset {

/// Forces alone: leaves no instruction in a kernel.
struct WithoutHeat {
  static constexpr bool acts = false;
  using Source = WithoutHeat;
};

/// What contacts make of heat, as the options want it.
enum class HeatMade {
  by_slider, ///< ContactHeatOptions::slider_alone()
  by_any     ///< whatever else: found out batch by batch
};

/// The heat of a batch of contacts, beside its forces.
template <HeatMade made> class HeatBatch {
public:
  static constexpr bool acts = true;
  using Source = HeatOfContacts;

  explicit HeatBatch(const HeatOfContacts& heat);
  ~HeatBatch() { arrays_.sums[omp_get_thread_num()] += sums_; }
  HeatBatch(const HeatBatch&) = delete;
  HeatBatch& operator=(const HeatBatch&) = delete;

  /// Before the forces: the partners of pair k.
  void gather(int k, int i, int j, const int* type) {
    warmer_[k] = arrays_.temperature[j] - arrays_.temperature[i];
    if (types_ > 1)
      set_constants(k, law_.pair(type[i], type[j]));
  }
  /// With the forces.
  template <bool rolls> void set(int k, const ContactForce& f) {
    pressing_[k] = f.pressing;
    overlap_[k] = f.overlap;
    reduced_radius_[k] = f.reduced_radius;
    friction_[k] = f.heat.sliding;
    if constexpr (rolls)
      friction_[k] += f.heat.rolling;
    if constexpr (made == HeatMade::by_any) {
      slider_force_[k] = f.heat.slider_force;
      slip_squared_[k] = f.heat.slip_squared;
      damping_[k] = f.heat.damping;
      rolling_[k] = f.heat.rolling;
    }
  }
  /// After the forces, of which some particles are `own`.
  void evaluate(const ContactBatch& batch, int count, Range own);

  [[nodiscard]] double& rate(int particle) const { return arrays_.rate[particle]; }
  [[nodiscard]] double rate_of_i(int k) const { return rate_i_[k]; }
  void add_to_j(int j, int k) const { arrays_.rate[j] += rate_j_[k]; }

private:
  void set_constants(int k, const ContactHeat::PairConstants& pair) {
    per_radius_[k] = pair.conductance_per_radius;
    inverse_modulus_[k] = pair.inverse_modulus;
    overlap_ratio_[k] = pair.overlap_ratio;
    share_[k] = pair.share;
  }
  void count_what_is_made(int whole_groups);
  template <class Radius>
  void exchange(const Radius& radius, const ContactBatch& batch, int whole_groups);
  void sum_up(const ContactBatch& batch, int count, Range own);
  void show(const ContactBatch& batch, int count, Range own) const;

  using Column = ContactBatch::Column;
  const ContactHeat& law_;
  const HeatArrays arrays_;
  const int types_;
  HeatSums sums_;               // of this object
  alignas(64) Column warmer_{}; // j than i
  alignas(64) Column per_radius_{}, inverse_modulus_{}, overlap_ratio_{}, share_{};
  alignas(64) Column pressing_{}, overlap_{}, reduced_radius_{};
  alignas(64) Column friction_{}, slider_force_{}, slip_squared_{}, rolling_{}, damping_{};
  alignas(64) Column conductance_{}, conduction_{}, rate_i_{}, rate_j_{};
};

extern template class HeatBatch<HeatMade::by_slider>;
extern template class HeatBatch<HeatMade::by_any>;

} // namespace granflux::particle_subset
