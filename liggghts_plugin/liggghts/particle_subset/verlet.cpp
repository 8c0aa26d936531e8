// SPDX-FileCopyrightText: 2026 The GranFlux developers
// SPDX-License-Identifier: GPL-2.0-or-later

#include "verlet.hpp"

#include <algorithm>
#include <cstdio>
#include <cstring>
#include <ctime>
#include <string>
#include <string_view>

#include <omp.h>

#include <liggghts/atom.h>

#include <liggghts/atom_vec.h>
#include <liggghts/comm.h>
#include <liggghts/domain.h>
#include <liggghts/force.h>
#include <liggghts/modify.h>
#include <liggghts/output.h>
#include <liggghts/pair.h>
#include <liggghts/signal_handling.h>
#include <liggghts/timer.h>
#include <liggghts/update.h>

#include "fix_nve_sphere.hpp"
#include "neighbor.hpp"
#include "pair_gran.hpp"
#include "rare_look.hpp"
#include "team.hpp"
#include "work_ahead.hpp"
#include "work_times.hpp"

namespace granflux::particle_subset {

namespace {

using namespace LAMMPS_NS::FixConst;
using LAMMPS_NS::bigint;

/// They move triangles; of particles they know the forces only.
bool moves_meshes_only(const LAMMPS_NS::Fix& fix) {
  const std::string_view style = fix.style;
  return style.starts_with("mesh/surface") || style.starts_with("move/mesh");
}

bool is_wall(const LAMMPS_NS::Fix& fix) {
  return std::string_view(fix.style).starts_with("wall/");
}

/// True if every fix that is called at one of `stages` is FixNveSphere or moves meshes only.
bool only_own_fixes_at(const LAMMPS_NS::Modify& modify, int stages) {
  for (int i = 0; i < modify.nfix; ++i)
    if ((modify.fmask[i] & stages) && !dynamic_cast<FixNveSphere*>(modify.fix[i]) &&
        !dynamic_cast<RareLook*>(modify.fix[i]) && !moves_meshes_only(*modify.fix[i]))
      return false;
  return true;
}

/// Fixes called before the forces are computed that neither set nor read any.
bool look_at_no_forces(const LAMMPS_NS::Modify& modify) {
  for (int i = 0; i < modify.nfix; ++i) {
    const LAMMPS_NS::Fix& fix = *modify.fix[i];
    const std::string_view style = fix.style;
    if ((modify.fmask[i] & PRE_FORCE) && !moves_meshes_only(fix) && style != "wall/gran" &&
        style != "neighlist/mesh" && style != "granflux/heat" &&
        !style.starts_with("contacthistory"))
      return false;
  }
  return true;
}

/// No fix is called between forces and motion that looks at forces.
bool forces_are_for_motion_alone(const LAMMPS_NS::Modify& modify) {
  for (int i = 0; i < modify.nfix; ++i) {
    const LAMMPS_NS::Fix& fix = *modify.fix[i];
    const auto* rare = dynamic_cast<const RareLook*>(&fix);
    if ((modify.fmask[i] & PRE_FINAL_INTEGRATE) && !moves_meshes_only(fix) &&
        (!rare || rare->looks_at_forces()))
      return false;
  }
  return true;
}

std::vector<const RareLook*> rare_looks(const LAMMPS_NS::Modify& modify) {
  std::vector<const RareLook*> found;
  for (int i = 0; i < modify.nfix; ++i)
    if (const auto* look = dynamic_cast<const RareLook*>(modify.fix[i]))
      found.push_back(look);
  return found;
}

std::vector<WorkAhead*> work_ahead(const LAMMPS_NS::Modify& modify) {
  std::vector<WorkAhead*> found;
  for (int i = 0; i < modify.nfix; ++i)
    if (auto* work = dynamic_cast<WorkAhead*>(modify.fix[i]))
      found.push_back(work);
  return found;
}

bool any_box_change(const LAMMPS_NS::Modify& modify) {
  for (int i = 0; i < modify.nfix; ++i) {
    const LAMMPS_NS::Fix& fix = *modify.fix[i];
    if (fix.box_change_size || fix.box_change_shape || fix.box_change_domain)
      return true;
  }
  return false;
}

bool all_motion_is_own(const LAMMPS_NS::Modify& modify) {
  for (int i = 0; i < modify.nfix; ++i)
    if (modify.fix[i]->time_integrate && !dynamic_cast<FixNveSphere*>(modify.fix[i]))
      return false;
  return !any_box_change(modify) &&
         only_own_fixes_at(modify, PRE_INITIAL_INTEGRATE | INITIAL_INTEGRATE | POST_INTEGRATE);
}

/// The fixes that may take the second half of a step with the first half of the next: all that
/// move particles, and nobody is called in between who could look at velocities.
std::vector<FixNveSphere*> fixes_that_may_owe(const LAMMPS_NS::Modify& modify) {
  if (!only_own_fixes_at(modify,
                         FINAL_INTEGRATE | END_OF_STEP | PRE_INITIAL_INTEGRATE | INITIAL_INTEGRATE))
    return {};
  std::vector<FixNveSphere*> found;
  for (int i = 0; i < modify.nfix; ++i)
    if (auto* fix = dynamic_cast<FixNveSphere*>(modify.fix[i])) {
      if (!fix->may_owe())
        return {};
      found.push_back(fix);
    }
  return found;
}

bool asked_to_stop() {
  return LAMMPS_NS::SignalHandler::request_quit && !LAMMPS_NS::SignalHandler::request_write_restart;
}

void clear(LAMMPS_NS::Atom* atom, Range range) {
  if (range.size() <= 0)
    return;
  const auto bytes = 3 * sizeof(double) * std::size_t(range.size());
  std::memset(atom->f[range.begin], 0, bytes);
  std::memset(atom->torque[range.begin], 0, bytes);
}

} // namespace

void Verlet::setup() {
  const std::time_t now = std::time(nullptr);
  if (comm->me == 0)
    for (FILE* file : {screen, logfile})
      if (file)
        std::fprintf(file, "Setting up run at %s\n", std::ctime(&now));
  update->setupflag = 1;

  atom->setup();
  modify->setup_pre_exchange(); // what fixes keep by the old lists goes to the particles
  domain->pbc();
  domain->reset_box();
  comm->setup();
  if (neighbor->style)
    neighbor->setup_bins();
  comm->exchange();
  if (atom->sortfreq > 0)
    sort_particles();
  comm->borders();
  modify->setup_pre_neighbor();
  neighbor->build();
  neighbor->ncalls = 0;

  ev_set(update->ntimestep);
  force_clear();
  modify->setup_pre_force(vflag);
  if (pair_compute_flag)
    force->pair->compute(eflag, vflag);
  modify->setup(vflag);
  output->setup();
  update->setupflag = 0;
  set_up_ = true;
}

void Verlet::sort_particles() {
  // Where contacts are LIGGGHTS' own they are added up in its order: the same bits.
  const auto* own = dynamic_cast<const PairGran*>(force->pair);
  if (!own || !own->holds_history()) {
    atom->sort();
    return;
  }
  order_.sort(*atom, *modify, 0.5 * neighbor->cutneighmax);
  atom->nextsort = (update->ntimestep / atom->sortfreq + 1) * atom->sortfreq;
}

void Verlet::run(int steps) {
  // Without a setup the script may have moved particles since the lists were built.
  if (auto* own = dynamic_cast<Neighbor*>(neighbor))
    own->hears_all_motion(set_up_ && all_motion_is_own(*modify));
  may_owe_ = fixes_that_may_owe(*modify);
  rare_looks_ = rare_looks(*modify);
  work_ahead_ = work_ahead(*modify);
  fixes_before_forces_look_at_none_ = look_at_no_forces(*modify);
  may_move_ahead_ = only_own_fixes_at(*modify, PRE_FINAL_INTEGRATE);
  may_clear_ahead_ = fixes_before_forces_look_at_none_ && forces_are_for_motion_alone(*modify);
  cleared_ahead_ = false;
  load_ = {};
  WorkTimes& times = work_times();
  times = {};
  {
    const Lap lap(times.total);
    run_steps(steps);
  }
  // A run that continues another, `pre no`, does so silently.
  if (set_up_ && load_.steps > 0)
    report();
  set_up_ = false;
}

void Verlet::report() {
  load_.particles /= load_.steps;
  load_.ghosts /= load_.steps;
  load_.threads = omp_get_max_threads();
  const std::string text = work_report(work_times(), load_, world);
  if (comm->me != 0)
    return;
  for (FILE* file : {screen, logfile})
    if (file)
      std::fputs(text.c_str(), file);
}

void Verlet::run_steps(int steps) {
  WorkTimes& times = work_times();
  for (int i = 0; i < steps; ++i) {
    const bigint now = ++update->ntimestep;
    ev_set(now);
    {
      const Lap lap(times.integration);
      if (modify->n_pre_initial_integrate)
        modify->pre_initial_integrate();
      modify->initial_integrate(vflag);
      if (modify->n_post_integrate)
        modify->post_integrate();
    }
    if (lists_have_aged()) {
      exchange_and_build_lists(now);
    } else {
      const Lap lap(times.communication);
      timer->stamp();
      comm->forward_comm();
      timer->stamp(TIME_COMM);
    }
    ++load_.steps;
    load_.particles += atom->nlocal;
    load_.ghosts += atom->nghost;
    const bool seen = i + 1 == steps || now == output->next || looked_at(now) || asked_to_stop();
    owed_ = !seen && !may_owe_.empty();
    compute_forces();
    {
      const double gas_before = times.gas;
      {
        const Lap lap(times.integration);
        if (modify->n_pre_final_integrate)
          modify->pre_final_integrate();
        final_integrate();
      }
      times.integration -= times.gas - gas_before;
    }
    if (modify->n_end_of_step) {
      const Lap lap(times.other_fixes);
      modify->end_of_step();
    }
    if (now == output->next) {
      const Lap lap(times.output);
      timer->stamp();
      output->write(now);
      timer->stamp(TIME_OUTPUT);
    }
    if (asked_to_stop() && !owed_) // else at the end of the next step
      return;
  }
}

bool Verlet::looked_at(bigint step) const {
  return std::ranges::any_of(rare_looks_,
                             [&](const RareLook* look) { return look->looks_at(long(step)); });
}

bool Verlet::lists_have_aged() {
  const Lap lap(work_times().neighbour_lists);
  return neighbor->decide();
}

void Verlet::exchange_and_build_lists(bigint now) {
  WorkTimes& times = work_times();
  cleared_ahead_ = false;
  {
    const Lap lap(times.neighbour_lists);
    if (modify->n_pre_exchange)
      modify->pre_exchange();
  }
  {
    const Lap lap(times.communication);
    domain->pbc();
    if (domain->box_change) {
      domain->reset_box();
      comm->setup();
      if (neighbor->style)
        neighbor->setup_bins();
    }
    timer->stamp();
    comm->exchange();
    if (atom->sortfreq > 0 && now >= atom->nextsort)
      sort_particles();
    comm->borders();
    timer->stamp(TIME_COMM);
  }
  const Lap lap(times.neighbour_lists);
  if (modify->n_pre_neighbor)
    modify->pre_neighbor();
  const double lists_before = times.contact_lists;
  neighbor->build(1);
  times.neighbour_lists -= times.contact_lists - lists_before;
  timer->stamp(TIME_NEIGHBOR);
}

bool Verlet::ClearForces::begin_own_work(int /*eflag*/, int /*vflag*/) {
  LAMMPS_NS::Atom* const atom = verlet.atom;
  clear(atom, {.begin = atom->nlocal, .end = atom->nlocal + atom->nghost});
  cleared_.resize(std::size_t(omp_get_max_threads()));
  return true;
}

void Verlet::ClearForces::start_own_work(int thread, Range own) {
  const PairGran* const contacts = verlet.contacts_in_team_;
  const int end = contacts ? contacts->contacts_of(thread).reach_of_lower() : own.end;
  clear_but_ahead(thread, {own.begin, end});
  cleared_[std::size_t(thread)].end = end;
}

void Verlet::ClearForces::own_work(int thread, Range block) {
  const PairGran* const contacts = verlet.contacts_in_team_;
  if (!contacts)
    return;
  int& cleared = cleared_[std::size_t(thread)].end;
  const int end = contacts->contacts_of(thread).reach_of_block(block);
  clear_but_ahead(thread, {cleared, end});
  cleared = end;
}

/// Not what was cleared in the last step, whose lists are those of this one.
void Verlet::ClearForces::clear_but_ahead(int thread, Range range) const {
  if (!verlet.cleared_ahead_ || !verlet.contacts_in_team_) {
    clear(verlet.atom, range);
    return;
  }
  const Range ahead = verlet.contacts_in_team_->contacts_of(thread).unseen;
  clear(verlet.atom, {range.begin, std::min(range.end, ahead.begin)});
  clear(verlet.atom, {std::max(range.begin, ahead.end), range.end});
}

bool Verlet::MoveAhead::begin_own_work(int /*eflag*/, int /*vflag*/) {
  for (FixNveSphere* fix : verlet.may_owe_)
    fix->may_move_ahead(omp_get_max_threads());
  return true;
}

void Verlet::MoveAhead::own_work(int thread, Range block) {
  const Range unseen = verlet.contacts_in_team_->contacts_of(thread).unseen;
  const Range moved{std::max(block.begin, unseen.begin), std::min(block.end, unseen.end)};
  if (moved.size() <= 0)
    return;
  for (FixNveSphere* fix : verlet.may_owe_)
    fix->move_ahead(thread, moved);
  if (verlet.may_clear_ahead_)
    clear(verlet.atom, moved);
}

void Verlet::finish_team() {
  team_.work(atom->nlocal, work_times().waiting);
  contacts_in_team_ = nullptr;
}

bool Verlet::add_part(OwnWork* part, double& seconds, auto&& otherwise) {
  bool begun = false;
  if (part) {
    const Lap lap(seconds);
    begun = part->begin_own_work(eflag, vflag);
  }
  if (begun) {
    team_.add(*part, seconds);
    return true;
  }
  finish_team();
  const Lap lap(seconds);
  otherwise();
  return false;
}

void Verlet::compute_forces() {
  WorkTimes& times = work_times();
  add_part(&clear_, times.other_fixes, [] {});
  if (!fixes_before_forces_look_at_none_)
    finish_team();
  if (modify->n_pre_force) {
    const Lap lap(times.other_fixes);
    modify->pre_force(vflag);
  }
  const double contacts_before = times.contacts;
  if (pair_compute_flag) {
    auto* own = dynamic_cast<PairGran*>(force->pair);
    if (add_part(own, times.contacts, [&] { force->pair->compute(eflag, vflag); }))
      contacts_in_team_ = own;
  }
  for (int i = 0; i < modify->nfix; ++i)
    if (modify->fmask[i] & POST_FORCE) {
      LAMMPS_NS::Fix& fix = *modify->fix[i];
      // The same way whether or not the host times its fixes: another would round otherwise. Our
      // own are timed here.
      OwnWork* part = dynamic_cast<OwnWork*>(&fix);
      const bool timed_by_host = modify->timing && !part;
      add_part(part, is_wall(fix) ? times.walls : times.other_fixes, [&] {
        if (timed_by_host)
          fix.begin_time_recording();
        fix.post_force(vflag);
        if (timed_by_host)
          fix.end_time_recording();
      });
    }
  if (may_move_ahead_ && contacts_in_team_)
    for (WorkAhead* work : work_ahead_)
      if (OwnWork* part = work->work_ahead())
        add_part(part, times.integration, [] {});
  const bool ahead = owed_ && may_move_ahead_ && contacts_in_team_ && !team_.looks_back();
  if (ahead)
    add_part(&move_ahead_, times.integration, [] {});
  finish_team();
  cleared_ahead_ = ahead && may_clear_ahead_;
  timer->array[TIME_PAIR] += times.contacts - contacts_before;
  timer->stamp();
}

void Verlet::final_integrate() {
  if (!owed_) {
    modify->final_integrate();
    return;
  }
  for (int i = 0; i < modify->nfix; ++i)
    if (modify->fmask[i] & FINAL_INTEGRATE) {
      if (auto* own = dynamic_cast<FixNveSphere*>(modify->fix[i]))
        own->owe_final_integrate();
      else
        modify->fix[i]->final_integrate();
    }
}

namespace {

/// What Verlet::run() does not deal with: bonds, long-range forces, oblique boxes, forces handed
/// back by ghosts, and the arrays of other particle styles.
bool spheres_only(const LAMMPS_NS::LAMMPS& lammps) {
  const LAMMPS_NS::Atom& atom = *lammps.atom;
  return atom.sphere_flag && !atom.molecular && !atom.erforce_flag && !atom.e_flag &&
         !atom.rho_flag && !lammps.force->kspace && !lammps.force->newton &&
         !lammps.domain->triclinic && lammps.neighbor->includegroup == 0 &&
         lammps.modify->find_fix("package_omp") < 0;
}

} // namespace

void take_over_integrator(LAMMPS_NS::LAMMPS& lammps) {
  LAMMPS_NS::Update& update = *lammps.update;
  const bool runs = update.whichflag == 1;
  if (!runs || std::string_view(update.integrate_style) != "verlet")
    return;
  const bool ours = dynamic_cast<Verlet*>(update.integrate);
  if (ours == spheres_only(lammps))
    return;
  delete update.integrate;
  if (ours)
    update.integrate = new LAMMPS_NS::Verlet(&lammps, 0, nullptr);
  else
    update.integrate = new Verlet(&lammps, 0, nullptr);
  update.integrate->init();
}

} // namespace granflux::particle_subset
