// SPDX-FileCopyrightText: 2026 The GranFlux developers
// SPDX-License-Identifier: GPL-2.0-or-later

#include "fix_couple.hpp"

#include <string>
#include <string_view>
#include <vector>

#include <fmt/core.h>

#include "fmt_of_lammps.hpp"

#include <lammps/atom.h>
#include <lammps/domain.h>
#include <lammps/error.h>
#include <lammps/group.h>
#include <lammps/modify.h>
#include <lammps/timer.h>
#include <lammps/update.h>

#include "driver/fixes_of_run.hpp"
#include "driver/guard.hpp"
#include "driver/restart_values.hpp"
#include "driver/scene_of_script.hpp"
#include "fix_checkpoint.hpp"
#include "scene.hpp"

namespace granflux::lammps {

namespace {

/// What dumps see of a FluidState: drag coefficient, void fraction, gas velocity, pressure force
/// and fluid force. What follows is of the books.
constexpr int shown_columns = 11;

} // namespace

FixCouple::FixCouple(LAMMPS_NS::LAMMPS* lammps, int narg, char** arg)
    : Fix(lammps, narg, arg), fluid_({}) {
  restart_global = restart_peratom = 1;
  create_attribute = 1;
  vector_flag = 1;
  size_vector = driver::GasDriver::values;
  global_freq = 1;
  extvector = 0;
  driver::guard(*this, *error, [&] {
    driver::refuse_second_fix(*modify, style, ": there can be one gas only");
    gas_ = std::make_unique<driver::GasDriver>(std::span(arg + 3, std::size_t(narg - 3)), world);
    if (gas_->solves_gas())
      fluid_ = ParticleRows(std::vector<double>(coupling::fluid_state_doubles));
    if (gas_->with_heat())
      heat_states_.emplace(std::vector<double>(coupling::heat_state_doubles));
    const std::string& held = gas_->options().fixed_group;
    const int held_group = held.empty() ? 0 : group->find(held);
    if (held_group < 0)
      throw ConfigError(fmt::format("fixed_group {}: no such group", held));
    host_ = std::make_unique<HostView>(lmp, fluid_, groupbit,
                                       held.empty() ? 0 : group->bitmask[held_group]);
  });
  if (gas_->solves_gas()) {
    peratom_flag = 1;
    size_peratom_cols = shown_columns;
    peratom_freq = 1;
  }
  maxexchange = maxsize_restart();
  grow_arrays(atom->nmax);
  atom->add_callback(LAMMPS_NS::Atom::GROW);
  atom->add_callback(LAMMPS_NS::Atom::RESTART);
}

FixCouple::~FixCouple() {
  atom->delete_callback(id, LAMMPS_NS::Atom::GROW);
  atom->delete_callback(id, LAMMPS_NS::Atom::RESTART);
}

int FixCouple::setmask() {
  return LAMMPS_NS::FixConst::POST_FORCE | LAMMPS_NS::FixConst::POST_RUN;
}

void FixCouple::init() {
  driver::guard(*this, *error, [&] {
    check_script(driver::script_of(*lmp, rigid_fix_of(*lmp)));
    gas_->choose_effects(*host_);
  });
  warn_of_later_forces();
}

/// LAMMPS calls fixes in the order of the script. Drag is exact with the forces that are known.
void FixCouple::warn_of_later_forces() {
  bool later = false;
  for (int i = 0; i < modify->nfix && !warned_of_later_forces_; ++i) {
    const Fix* other = modify->fix[i];
    if (later && (modify->fmask[i] & LAMMPS_NS::FixConst::POST_FORCE) &&
        std::string_view(other->style) != "freeze" && !dynamic_cast<const FixHeat*>(other)) {
      host_->say(fmt::format("granflux: WARNING: fix {} (style {}) comes after fix {}, which does "
                             "not see its forces: define the gas after fixes that add forces\n",
                             other->id, other->style, id));
      warned_of_later_forces_ = true;
    }
    later = later || other == this;
  }
}

void FixCouple::setup(int) {
  driver::guard(*this, *error, [&] {
    host_->find_held();
    find_heat();
    gas_->set_up(*host_, run_steps(), update->dt);
    gas_->start_timers(); // LAMMPS' own begin after the set-up too
  });
}

/// Where the gas has a temperature, those of the particles are integrated together with it.
void FixCouple::find_heat() {
  if (!gas_->with_heat())
    return;
  auto* heat = driver::find_fix<FixHeat>(*modify);
  if (!heat)
    throw ConfigError("the case has an [energy] table, but particles have no temperature: define "
                      "fix granflux/heat");
  heat->leave_steps_to_gas(gas_->couple_every());
  host_->set_heat(*heat, *heat_states_);
}

driver::RunSteps FixCouple::run_steps() const {
  return {.first = long(update->ntimestep), .last = long(update->laststep)};
}

/// All forces of the step but those of later fixes are in the force array here, and velocities are
/// those of the middle of the step.
void FixCouple::post_force(int) {
  driver::guard(*this, *error, [&] {
    if (!gas_->running()) // a run without set-up (`run N pre no`)
      gas_->begin_run(run_steps());
    gas_->step(*host_, long(update->ntimestep), update->dt);
  });
}

void FixCouple::post_run() {
  if (!gas_->running())
    return;
  using LAMMPS_NS::Timer;
  driver::RunTimes times;
  times.other_fixes = timer->get_wall(Timer::MODIFY) - gas_->seconds();
  times.contacts = timer->get_wall(Timer::PAIR);
  times.neighbour_lists = timer->get_wall(Timer::NEIGH);
  times.communication = timer->get_wall(Timer::COMM);
  times.output = timer->get_wall(Timer::OUTPUT);
  times.total = timer->get_wall(Timer::TOTAL);
  const std::string report = gas_->end_run(times);
  if (update->ntimestep != update->firststep) // else no step was made: nothing to tell
    host_->say(report);
}

double FixCouple::compute_vector(int n) {
  return gas_->value(n);
}

int FixCouple::modify_param(int narg, char** arg) {
  if (narg < 2)
    return 0; // LAMMPS reports it
  bool known = false;
  driver::guard(*this, *error, [&] { known = gas_->modify(arg[0], arg[1]); });
  return known ? 2 : 0;
}

void FixCouple::write_restart(FILE* file) {
  driver::guard(*this, *error, [&] { gas_->write_state(file); });
}

void FixCouple::restart(char* block) {
  driver::guard(*this, *error, [&] { gas_->read_state(block); });
}

void FixCouple::grow_arrays(int n) {
  fluid_.grow(n);
  if (heat_states_)
    heat_states_->grow(n);
  array_atom = fluid_.pointers();
}

void FixCouple::copy_arrays(int from, int to, int) {
  fluid_.copy(from, to);
  if (heat_states_)
    heat_states_->copy(from, to);
}

void FixCouple::set_arrays(int particle) {
  fluid_.set_fresh(particle);
  if (heat_states_)
    heat_states_->set_fresh(particle);
}

int FixCouple::pack_exchange(int particle, double* buffer) {
  const int n = fluid_.pack(particle, buffer);
  return heat_states_ ? n + heat_states_->pack(particle, buffer + n) : n;
}

int FixCouple::unpack_exchange(int particle, double* buffer) {
  const int n = fluid_.unpack(particle, buffer);
  return heat_states_ ? n + heat_states_->unpack(particle, buffer + n) : n;
}

int FixCouple::pack_restart(int particle, double* buffer) {
  buffer[0] = maxsize_restart(); // the length, itself included
  pack_exchange(particle, buffer + 1);
  return maxsize_restart();
}

void FixCouple::unpack_restart(int particle, int nth) {
  unpack_exchange(particle, driver::restart_values(atom->extra, particle, nth));
}

int FixCouple::size_restart(int) {
  return maxsize_restart();
}

int FixCouple::maxsize_restart() {
  return fluid_.columns() + (heat_states_ ? heat_states_->columns() : 0) + 1;
}

double FixCouple::memory_usage() {
  return fluid_.bytes() + (heat_states_ ? heat_states_->bytes() : 0);
}

} // namespace granflux::lammps
