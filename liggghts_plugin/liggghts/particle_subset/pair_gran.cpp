// SPDX-FileCopyrightText: 2026 The GranFlux developers
// SPDX-License-Identifier: GPL-2.0-or-later

#include "pair_gran.hpp"

#include <algorithm>
#include <array>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include <fmt/core.h>
#include <omp.h>

#include <liggghts/atom.h>
#include <liggghts/comm.h>
#include <liggghts/error.h>
#include <liggghts/fix.h>
#include <liggghts/force.h>
#include <liggghts/modify.h>
#include <liggghts/neighbor.h>
#include <liggghts/properties.h>
#include <liggghts/update.h>

#include <granflux/cfd/error.hpp>
#include <granflux/coupling/throw_together.hpp>

#include "alike.hpp"
#include "contact_report.hpp"
#include "fix_contact_history.hpp"
#include "host_material.hpp"
#include "normal_law.hpp"
#include "say_once.hpp"
#include "work_times.hpp"

namespace granflux::particle_subset {

namespace {

/// Neighbor::exclusion is protected: a class derived from Neighbor may name it.
struct NeighborAccess : LAMMPS_NS::Neighbor {
  static auto exclusion_of_pair() { return &NeighborAccess::exclusion; }
};

Vec3* rows(double** array) {
  return array ? reinterpret_cast<Vec3*>(array[0]) : nullptr;
}

/// Fixes that make bodies of particles; names are compared up to their length.
constexpr std::array body_fixes{"rigid", "multisphere", "concave"};

std::unique_ptr<LAMMPS_NS::NeighList> new_list(LAMMPS_NS::LAMMPS* lammps, int doubles_a_pair) {
  auto made = std::make_unique<LAMMPS_NS::NeighList>(lammps);
  made->dnum = doubles_a_pair;
  made->ghostflag = 0; // read by its destructor, but not set by its constructor
  return made;
}

} // namespace

PairGran::PairGran(LAMMPS_NS::LAMMPS* lammps) : PairGranProxy(lammps) {}

PairGran::~PairGran() = default;

void PairGran::settings(int narg, char** arg) {
  words_ = read_gran_words({arg, std::size_t(narg)});
  kernel_ = make_contact_kernel(words_.laws, unknown_law_);
  PairGranProxy::settings(narg, arg);
}

std::string PairGran::reason_for_stock() {
  if (!kernel_)
    return unknown_law_.empty() ? "the models come from a restart file" : unknown_law_;
  if (!words_.malformed.empty())
    return words_.malformed;
  if (words_.surface != "default")
    return "surface " + words_.surface;
  if (const std::string option = words_.unsupported_option(); !option.empty())
    return option + " on";
  if (force->pair != this)
    return "pair_style hybrid";
  if (!atom->sphere_flag || atom->superquadric_flag || atom->shapetype_flag || !atom->radius_flag ||
      !atom->rmass_flag)
    return std::string("atom_style ") + atom->atom_style;
  if (force->newton_pair)
    return "newton on";
  if (force->nktv2p != 1)
    return std::string("units ") + update->unit_style;
  if (force->cg_active())
    return "coarsegraining";
  if (neighbor->includegroup)
    return "neigh_modify include";
  if (neighbor->contactDistanceFactor != 1)
    return "contact_distance_factor";
  if (dnum_pair() != kernel_->history_size())
    return "history of another model";
  for (const char* style : body_fixes)
    if (modify->n_fixes_style(style) > 0)
      return std::string("fix ") + style;
  for (int i = 0; i < modify->nfix; ++i)
    if (modify->fix[i]->n_history_extra() > 0)
      return std::string("fix ") + modify->fix[i]->style;
  return {};
}

void PairGran::init_style() {
  const std::string reason = reason_for_stock();
  const bool by_subset = reason.empty();
  // The lists of the other kind go out of use: what they remember goes to the particles first.
  if (by_subset != by_subset_ && computeflag_ && fix_history)
    fix_history->setup_pre_exchange();
  by_subset_ = by_subset;
  heat_ = near_heat_ = nullptr;
  needs_neighlist = !by_subset;
  PairGranProxy::init_style();
  if (by_subset) {
    shown_ = new_list(lmp, 0);
    shown_history_ = new_list(lmp, dnum());
    shown_->listgranhistory = shown_history_.get();
    shown_->fix_history = fix_history;
    list = shown_.get();
    listgranhistory = history ? shown_history_.get() : nullptr;
    say_once(*lmp, "contact forces by particle subset");
  } else {
    say_once(
        *lmp,
        fmt::format("contact forces are LIGGGHTS' own: {} has no form by particle subset", reason));
  }
}

void PairGran::init_granular() {
  PairGranProxy::init_granular();
  if (by_subset_)
    kernel_->read(HostMaterial(force->registry, words_, "pair_style gran"),
                  atom->get_properties()->max_type());
  if (const std::string report = granflux::liggghts::contact_report(*lmp); !report.empty())
    say_once(*lmp, report);
}

std::optional<NormalForce> PairGran::normal_force(int a, int b, const Contact& contact) const {
  if (!words_.malformed.empty() || !words_.unsupported_option().empty())
    return {};
  return particle_subset::normal_force(
      words_.laws.normal, HostMaterial(force->registry, words_, "pair_style gran"), a, b, contact);
}

Particles PairGran::particles() const {
  return {.owned = atom->nlocal,
          .all = atom->nlocal + atom->nghost,
          .position = rows(atom->x),
          .velocity = rows(atom->v),
          .spin = rows(atom->omega),
          .radius = atom->radius,
          .mass = atom->rmass,
          .type = atom->type,
          .tag = atom->tag,
          .groups = atom->mask,
          .alike = alike_,
          .frozen_group = freeze_group_bit(),
          .force = rows(atom->f),
          .torque = rows(atom->torque)};
}

/// Types and sizes change where lists are built, or by a command before a run that builds none;
/// sizes, and those only, also by fixes.
void PairGran::look_what_is_alike() {
  alike_ = find_alike(particles());
  if (atom->radvary_flag || !sizes_stay(*modify))
    alike_.radius = alike_.mass = 0;
}

void PairGran::look_what_is_alike_in_new_run() {
  if (update->ntimestep <= update->firststep + 1)
    look_what_is_alike();
}

bool PairGran::begin_own_work(int eflag, int vflag) {
  if (!by_subset_ || forceoff() || update->setupflag)
    return false;
  shearupdate_ = 1; // as PairGranProxy::compute() has it in a step
  if (!only_forces_wanted(eflag, vflag, 0))
    return false;
  computeflag_ = 1;
  evflag = vflag_fdotr = 0;
  look_what_is_alike_in_new_run();
  if (heat_)
    heat_now_ = heat_->heat_of_contacts();
  return true;
}

void PairGran::start_own_work(int thread, Range own) {
  const ThreadContacts& contacts = lists_.of(thread);
  if (heat_) {
    const Range reached{own.begin, contacts.reach_of_lower()};
    clear_heat(reached);
    call_heat_to_cache(reached);
  }
  kernel_->add_lower(particles(), lists_.of(thread), update->dt, heat());
}

void PairGran::own_work(int thread, Range block) {
  if (heat_) { // while it is in the cache: what the rows before have added to is cleared
    const ThreadContacts& contacts = lists_.of(thread);
    const Range before{contacts.own.begin, block.begin};
    const Range reached{contacts.reach_of_block(before), contacts.reach_of_block(block)};
    clear_heat(reached);
    call_heat_to_cache(reached);
  }
  kernel_->add_upper(particles(), lists_.of(thread), block, update->dt, heat());
}

/// Rates of the last step of temperature stay until there is another; what resists motion is of
/// each time step.
void PairGran::clear_heat(Range range) const {
  const HeatArrays& arrays = heat_now_.arrays;
  if (!arrays.kept.now)
    std::fill(arrays.rate + range.begin, arrays.rate + range.end, 0.0);
  for (Resistance* of : {arrays.resistances.damping, arrays.resistances.rubbing})
    if (of)
      std::fill(of + range.begin, of + range.end, Resistance{});
}

/// What contacts read or add to of particles that they reach first now, line after line: a look at
/// one particle in a hundred instructions the machine does not foresee, and to call for each pair
/// takes longer.
void PairGran::call_heat_to_cache(Range range) const {
  const HeatArrays& arrays = heat_now_.arrays;
  const double* const of = arrays.kept.now ? arrays.kept.friction : arrays.temperature;
  if (!of)
    return;
  for (int p = range.begin; p < range.end; p += Subset::line)
    __builtin_prefetch(of + p, 0, 2);
}

/// In a step whose forces are left to LIGGGHTS' loop: forces and histories go nowhere.
void PairGran::add_heat_alone() {
  heat_now_ = heat_->heat_of_contacts();
  Particles all = particles();
  std::vector<Vec3> forces(std::size_t(all.owned)), torques(forces.size());
  all.force = forces.data();
  all.torque = torques.data();
  clear_heat({0, all.owned});
#pragma omp parallel for num_threads(lists_.subset().threads()) schedule(static, 1)
  for (int thread = 0; thread < lists_.subset().threads(); ++thread) {
    ThreadContacts contacts = lists_.of(thread);
    kernel_->add(all, contacts, update->dt, heat());
  }
}

void PairGran::build_lists() {
  if (!by_subset_)
    return;
  const Lap lap(work_times().contact_lists);
  ContactLists::Excluded excluded;
  if (neighbor->exclude_setting())
    excluded = [this](int i, int j) {
      return (neighbor->*NeighborAccess::exclusion_of_pair())(i, j, atom->type[i], atom->type[j],
                                                              atom->mask, atom->molecule) != 0;
    };
  PartnerHistory kept;
  if (auto* fix = dynamic_cast<FixContactHistory*>(fix_history))
    kept = fix->arrays();
  look_what_is_alike();
  const double reach = near_heat_ ? near_heat_->reach() : 0;
  // Forces between frozen particles move nothing; heat does go through their contacts.
  const int at_rest = heat_ || near_heat_ ? 0 : freeze_group_bit();
  lists_.build(particles(), neighbor->skin + reach, omp_get_max_threads(), kernel_->history_size(),
               excluded, kept, at_rest);
  refuse_coincident();
  add_parted_heat();
  show_lists_to_host();
}

/// Stops on all ranks alike where two particles are at the very same place, before their contact
/// makes numbers of no value.
void PairGran::refuse_coincident() const {
  std::string complaint;
  for (int thread = 0; thread < lists_.subset().threads() && complaint.empty(); ++thread)
    if (const auto& pairs = lists_.of(thread).coincident; !pairs.empty()) {
      const auto [i, j] = pairs.front();
      const Vec3& x = rows(atom->x)[i];
      complaint =
          fmt::format("particles {} and {} are both at ({:.10g}, {:.10g}, {:.10g}) m: their "
                      "contact has no direction; move or delete one of them",
                      std::min(atom->tag[i], atom->tag[j]), std::max(atom->tag[i], atom->tag[j]),
                      x.x, x.y, x.z);
    }
  try {
    coupling::throw_together<NumericalError>(world, complaint);
  } catch (const NumericalError& e) {
    error->all(FLERR, e.what());
  }
}

void PairGran::show_lists_to_host() {
  shown_->grow(atom->nmax);
  shown_history_->grow(atom->nmax);
  shown_->inum = atom->nlocal;
  const auto size = std::size_t(lists_.history_size());
#pragma omp parallel for num_threads(lists_.subset().threads()) schedule(static, 1)
  for (int thread = 0; thread < lists_.subset().threads(); ++thread) {
    const Range own = lists_.of(thread).own;
    ContactRows& upper = lists_.of(thread).upper;
    for (int i = own.begin; i < own.end; ++i) {
      const auto begin = std::size_t(upper.row_begin(i - own.begin));
      shown_->ilist[i] = i;
      shown_->numneigh[i] = upper.row_end(i - own.begin) - int(begin);
      shown_->firstneigh[i] = upper.partner.data() + begin;
      if (size > 0) {
        shown_history_->firstneigh[i] = upper.flags.data() + begin;
        shown_history_->firstdouble[i] = upper.history.data() + begin * size;
      }
    }
  }
}

bool PairGran::only_forces_wanted(int eflag, int vflag, int addflag) {
  return !eflag && !vflag && !addflag && shearupdate() && !storeContactForces() &&
         !storeContactForcesStress() && !storeSumDelta() && !store_sum_normal_force();
}

void PairGran::compute_force(int eflag, int vflag, int addflag) {
  if (!by_subset_) {
    PairGranProxy::compute_force(eflag, vflag, addflag);
    return;
  }
  look_what_is_alike_in_new_run();
  if (!only_forces_wanted(eflag, vflag, addflag)) {
    if (heat_ && computeflag() && shearupdate() && !addflag)
      add_heat_alone();
    PairGranProxy::compute_force(eflag, vflag, addflag); // along the lists that are shown to it
    if (computeflag() && shearupdate())
      lists_.mirror_history();
    return;
  }
  evflag = vflag_fdotr = 0;
  const Particles all = particles();
  const bool makes_heat = heat_ && shearupdate(); // not in a setup
  if (makes_heat) {
    heat_now_ = heat_->heat_of_contacts();
    clear_heat({0, all.owned});
  }
#pragma omp parallel for num_threads(lists_.subset().threads()) schedule(static, 1)
  for (int thread = 0; thread < lists_.subset().threads(); ++thread)
    kernel_->add(all, lists_.of(thread), update->dt, makes_heat ? heat() : nullptr);
}

void PairGran::add_near_heat(const NearHeat& law, const HeatArrays& arrays) {
  const Particles all = particles();
  facing_.resize(std::size_t(all.owned));
#pragma omp parallel for num_threads(lists_.subset().threads()) schedule(static, 1)
  for (int thread = 0; thread < lists_.subset().threads(); ++thread)
    law.add(all, lists_.of(thread), arrays, arrays.sums[thread], facing_);
}

int PairGran::store_history(PartnerHistory kept) {
  if (heat_ && heat_->parted_heat()) {
    lists_.part_far(particles(), 0.5 * neighbor->skin);
    add_parted_heat();
  }
  return lists_.store(particles(), kept);
}

/// What springs hold whose contacts have ended becomes heat.
void PairGran::add_parted_heat() {
  double* const heat = heat_ ? heat_->parted_heat() : nullptr;
  if (!heat)
    return;
  const Particles all = particles();
  const ContactHeat& law = *heat_->heat_of_contacts().law;
  if (law.options().all_dissipated() && update->setupflag)
    return; // a step looks at what parts in it
#pragma omp parallel for num_threads(lists_.subset().threads()) schedule(static, 1)
  for (int thread = 0; thread < lists_.subset().threads(); ++thread)
    kernel_->add_parted(all, lists_.of(thread), update->dt, law, heat);
}

} // namespace granflux::particle_subset
