// SPDX-FileCopyrightText: 2026 The GranFlux developers
// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <liggghts/lammps.h>

#include <liggghts/neigh_list.h>
#include <liggghts/pair_gran_proxy.h>

#include "contact_kernel.hpp"
#include "contact_lists.hpp"
#include "gran_words.hpp"
#include "heat_port.hpp"
#include "near_heat.hpp"
#include "own_work.hpp"

namespace granflux::particle_subset {

/// `pair_style gran` with the contact forces computed by particle subset. Everything else is
/// LIGGGHTS' own: what has no form by subset, and steps that ask for more than forces (virial,
/// contacts for output), go through its loop.
class PairGran : public LAMMPS_NS::PairGranProxy, public OwnWork {
public:
  explicit PairGran(LAMMPS_NS::LAMMPS* lammps);
  ~PairGran() override;

  void settings(int narg, char** arg) override;
  void init_style() override;
  void init_granular() override;
  void compute_force(int eflag, int vflag, int addflag) override;

  /// When LIGGGHTS builds its lists: before fixes may change radii, and after fix contacthistory
  /// has taken the memory of contacts over.
  void build_lists();

  /// Forces alone, in a step: what compute() does.
  bool begin_own_work(int eflag, int vflag) override;
  void start_own_work(int thread, Range own) override;
  void own_work(int thread, Range block) override;
  [[nodiscard]] const ThreadContacts& contacts_of(int thread) const { return lists_.of(thread); }

  /// Whether contacts are remembered in the lists here, not in LIGGGHTS' own.
  [[nodiscard]] bool holds_history() const { return by_subset_; }
  /// Whether friction resists by speed, not by a slider. Only by particle subset.
  [[nodiscard]] bool rubs() const { return kernel_->rubs(); }
  /// Returns the most partners that one particle remembers.
  int store_history(PartnerHistory kept);

  /// Normal force of one contact of types a and b, for what follows from the law once a run;
  /// nothing where the law, or an option of it, has no form by particle subset.
  [[nodiscard]] std::optional<NormalForce> normal_force(int a, int b, const Contact& contact) const;
  [[nodiscard]] const std::string& normal_law() const { return words_.laws.normal; }

  /// From here on, until the next init_style(), contacts make heat too. Only by particle subset.
  void set_heat(HeatPort& heat) { heat_ = &heat; }
  /// Likewise for heat between particles that need not touch: lists reach as far.
  void set_near_heat(HeatPort& heat) { near_heat_ = &heat; }
  /// Adds the heat between particles near each other, touching or not, of the step whose contacts
  /// were computed last.
  void add_near_heat(const NearHeat& law, const HeatArrays& arrays);

private:
  void add_heat_alone();
  void clear_heat(Range range) const;
  void call_heat_to_cache(Range range) const;
  [[nodiscard]] const HeatOfContacts* heat() const { return heat_ ? &heat_now_ : nullptr; }
  [[nodiscard]] std::string reason_for_stock();
  void refuse_coincident() const;
  void add_parted_heat();
  void show_lists_to_host();
  void look_what_is_alike();
  void look_what_is_alike_in_new_run();
  [[nodiscard]] Particles particles() const;
  [[nodiscard]] bool only_forces_wanted(int eflag, int vflag, int addflag);

  GranWords words_;
  std::unique_ptr<ContactKernel> kernel_;
  std::string unknown_law_; // why there is no kernel
  bool by_subset_ = false;
  HeatPort* heat_ = nullptr;      // of contacts; null: none
  HeatPort* near_heat_ = nullptr; // of near particles; null: none
  HeatOfContacts heat_now_;       // of this step
  std::vector<double> facing_;    // of NearHeat, of each owned particle
  ContactLists lists_;
  Alike alike_; // as of the last look
  // The same lists in the form in which LIGGGHTS' loop, fixes and computes read them.
  std::unique_ptr<LAMMPS_NS::NeighList> shown_, shown_history_;
};

} // namespace granflux::particle_subset
