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
  template <class Law> static constexpr bool resists = false;
  template <class Law> static constexpr bool looks_at_partings = false;
  using Source = WithoutHeat;
};

/// What contacts make of heat, as the options want it.
enum class HeatMade {
  by_slider, ///< ContactHeatOptions::slider_at_most()
  by_any     ///< whatever else: found out batch by batch
};

/// The heat of a batch of contacts, beside its forces.
template <HeatMade made> class HeatBatch {
public:
  static constexpr bool acts = true;
  /// Whether what makes heat depends on speed: then the half kick adds to it.
  template <class Law> static constexpr bool resists = made == HeatMade::by_any || Law::rubs;
  /// Whether what springs hold when two part is noticed in that step.
  template <class Law>
  static constexpr bool looks_at_partings = made == HeatMade::by_any&& Law::history > 0;
  using Source = HeatOfContacts;

  explicit HeatBatch(const HeatOfContacts& heat);
  ~HeatBatch() { arrays_.sums[omp_get_thread_num()] += sums_; }
  HeatBatch(const HeatBatch&) = delete;
  HeatBatch& operator=(const HeatBatch&) = delete;

  /// Before the forces: of one pair; in advance of each lane, where all particles are of one type.
  void set_constants(int k, int type_i, int type_j) { set_constants(k, law_.pair(type_i, type_j)); }
  /// Calls what will be looked at after the forces: to wait for it now would hold up the rest.
  void gather(int, int, int j) const {
    __builtin_prefetch(to_ + j, 1);
    __builtin_prefetch(looked_at_ + j);
  }
  /// With the forces, of whole groups of lanes.
  template <class Law> void set(int k, const ContactForce& f) {
    pressing_[k] = f.pressing;
    overlap_[k] = f.overlap;
    reduced_radius_[k] = f.reduced_radius;
    friction_[k] = f.heat.sliding;
    if constexpr (Law::rolls)
      friction_[k] += f.heat.rolling;
    if constexpr (Law::rubs)
      rubbing_.set(k, f.rubbing);
    if constexpr (made == HeatMade::by_any) {
      slider_force_[k] = f.heat.slider_force;
      slip_squared_[k] = f.heat.slip_squared;
      damping_[k] = f.heat.damping;
      friction_[k] += f.heat.turning; // unless the slider is not counted
      rolling_[k] = f.heat.rolling;
      damper_.set(k, f.damping);
    }
  }
  /// After the forces: what the first `count` pairs, of which some particles are `own`, conduct and
  /// make; in a time step between two steps of temperature what they make is kept. What particles
  /// get of it, they get one by one afterwards.
  void add(const ContactBatch& batch, int count, Range own);
  void give_to_i(int k, int i) const { to_[i] += of_i_[k]; }
  void give_to_j(int k, int j) const { to_[j] += of_j_[k]; }
  [[nodiscard]] bool all_dissipated() const { return law_.options().all_dissipated(); }
  /// Adds the shares of what is left of a contact that has ended [W].
  void add_left(int i, int j, const int* type, double power, Range own);
  /// Adds what resists motion to the own particles.
  void resist(const ContactBatch& batch, int count, Range own) const;

private:
  void set_constants(int k, const ContactHeat::PairConstants& pair) {
    per_radius_[k] = pair.conductance_per_radius;
    inverse_modulus_[k] = pair.inverse_modulus;
    overlap_ratio_[k] = pair.overlap_ratio;
    share_[k] = pair.share;
  }
  void count_what_is_made(int whole_groups);
  void look_at_temperatures(const ContactBatch& batch, int count);
  void keep(const ContactBatch& batch, int count, Range own);
  void share_out(const ContactBatch::Column& power, int count);
  template <class Radius>
  void exchange(const Radius& radius, const ContactBatch& batch, int whole_groups);
  void take_off_others(const ContactBatch& batch, int count, Range own);
  void show(const ContactBatch& batch, int count, Range own) const;

  using Column = ContactBatch::Column;
  struct Resisting {
    ContactBatch::Vectors force, torque_i, torque_j;
    void set(int k, const ContactResistance& r) {
      force.set(k, r.force);
      torque_i.set(k, r.torque_i);
      torque_j.set(k, r.torque_j);
    }
    void add(const ContactBatch& batch, int count, Range own, Resistance* sums) const;
  };
  const ContactHeat& law_;
  const HeatArrays arrays_;
  double* const to_; // what particles get: rates, or energies between steps of temperature
  const bool conducts_;
  const double* const looked_at_; // temperatures, if it conducts; else that again
  HeatSums sums_;                 // of this object
  alignas(64) Column warmer_{};   // j than i
  // Written before they are read, in every batch: to clear them would cost more than some laws.
  alignas(64) Column per_radius_, inverse_modulus_, overlap_ratio_, share_;
  alignas(64) Column pressing_, overlap_, reduced_radius_;
  alignas(64) Column friction_, slider_force_, slip_squared_, rolling_, damping_;
  alignas(64) Column conductance_, conduction_, of_i_, of_j_;
  Resisting damper_, rubbing_;
};

extern template class HeatBatch<HeatMade::by_slider>;
extern template class HeatBatch<HeatMade::by_any>;

} // namespace granflux::particle_subset
