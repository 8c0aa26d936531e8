// SPDX-FileCopyrightText: 2026 The GranFlux developers
// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

#include "contact_batch.hpp"
#include "contact_heat.hpp"
#include "subset.hpp"

namespace granflux::particle_subset {

/// The sliders' work of a batch of contacts in a time step between two steps of temperature, where
/// it is all that contacts make of heat: the particles get it beside their forces, and nothing else
/// is found out.
class KeptWork {
public:
  static constexpr bool acts = true;
  template <class Law> static constexpr bool resists = false;
  template <class Law> static constexpr bool looks_at_partings = false;
  using Source = HeatOfContacts;

  explicit KeptWork(const HeatOfContacts& heat)
      : law_(*heat.law), energy_(heat.arrays.kept.friction), dt_(heat.arrays.kept.dt) {}
  KeptWork(const KeptWork&) = delete;
  KeptWork& operator=(const KeptWork&) = delete;

  /// Of one pair; in advance of each lane, where all particles are of one type.
  void set_constants(int k, int type_i, int type_j) { share_[k] = law_.pair(type_i, type_j).share; }
  void gather(int, int, int j) { __builtin_prefetch(energy_ + j, 1); }
  template <class Law> void set(int k, const ContactForce& f) {
    double power = f.heat.sliding;
    if constexpr (Law::rolls)
      power += f.heat.rolling;
    const double work = dt_ * power;
    of_i_[k] = share_[k] * work;
    of_j_[k] = work - of_i_[k];
  }
  void add(const ContactBatch&, int, Range) {}
  void give_to_i(int k, int i) const { energy_[i] += of_i_[k]; }
  void give_to_j(int k, int j) const { energy_[j] += of_j_[k]; }

private:
  const ContactHeat& law_;
  double* const energy_; // of owned particles [J]
  const double dt_;
  alignas(64) ContactBatch::Column share_, of_i_, of_j_;
};

} // namespace granflux::particle_subset
