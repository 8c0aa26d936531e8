// SPDX-FileCopyrightText: 2026 The GranFlux developers
// SPDX-License-Identifier: GPL-2.0-or-later

#include "fix_couple.hpp"

#include <algorithm>
#include <array>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <fmt/core.h>

#include <liggghts/lammps.h>

#include <liggghts/atom.h>
#include <liggghts/domain.h>
#include <liggghts/error.h>
#include <liggghts/fix_property_atom.h>
#include <liggghts/group.h>
#include <liggghts/modify.h>
#include <liggghts/output.h>
#include <liggghts/timer.h>
#include <liggghts/update.h>

#include "driver/fixes_of_run.hpp"
#include "driver/guard.hpp"
#include "driver/rows_of.hpp"
#include "driver/scene_of_script.hpp"
#include "fix_checkpoint.hpp"
#include "particle_subset/team.hpp"
#include "particle_subset/work_times.hpp"
#include "scene.hpp"

namespace granflux::liggghts {

namespace {

constexpr char fluid_property[] = "granflux_fluid";
constexpr char heat_property[] = "granflux_heat_state";
constexpr char gas_temperature_property[] = "gasTemperature";

/// Whether a fix may look at the outputs of each particle between two steps of output, as fix ave
/// does, or a variable that a fix takes. Of these it is known that they do not.
bool may_look(const LAMMPS_NS::Fix& fix) {
  constexpr std::array blind{"granflux/", "nve/",      "wall/gran",      "gravity",  "property/",
                             "mesh/",     "move/mesh", "contacthistory", "neighlist"};
  const std::string_view style = fix.style;
  return std::ranges::none_of(blind, [&](const char* name) { return style.starts_with(name); });
}

} // namespace

FixCouple::FixCouple(LAMMPS_NS::LAMMPS* lammps, int narg, char** arg) : Fix(lammps, narg, arg) {
  restart_global = 1;
  vector_flag = 1;
  size_vector = driver::GasDriver::values;
  global_freq = 1;
  extvector = 0;
  driver::guard(*this, *error, [&] {
    driver::refuse_second_fix(*modify, style, ": there can be one gas only");
    gas_ = std::make_unique<driver::GasDriver>(std::span(arg + 3, std::size_t(narg - 3)), world);
    const std::string& held = gas_->options().fixed_group;
    if (!held.empty() && group->find(held.c_str()) < 0)
      throw ConfigError(fmt::format("fixed_group {}: no such group", held));
  });
}

int FixCouple::setmask() {
  return LAMMPS_NS::FixConst::PRE_FINAL_INTEGRATE;
}

/// A fix property/atom of that name, made here unless the script has made one.
LAMMPS_NS::FixPropertyAtom* FixCouple::property(const char* name, int values, bool restarts,
                                                bool& own) {
  const char* shape = values == 1 ? "scalar" : "vector";
  if (Fix* found = modify->find_fix_property(name, "property/atom", shape, values, 0, style, false))
    return static_cast<LAMMPS_NS::FixPropertyAtom*>(found);
  own = true;
  std::vector<std::string> words{name, "all", "property/atom", name, shape, restarts ? "yes" : "no",
                                 "no", "no"};
  words.resize(words.size() + std::size_t(values), "0.");
  std::vector<char*> arguments;
  for (std::string& word : words)
    arguments.push_back(word.data());
  return modify->add_fix_property_atom(int(arguments.size()), arguments.data(), style);
}

void FixCouple::post_create() {
  const std::string& held = gas_->options().fixed_group;
  const int held_bit = held.empty() ? 0 : group->bitmask[group->find(held.c_str())];
  host_ = std::make_unique<HostView>(lmp, groupbit, held_bit);
  // A restart hands on what particles have before the first run only.
  if (gas_->solves_gas() && (gas_->effects_are_chosen() || gas_->continues()))
    make_properties();
}

/// What is not solved for holds no memory.
void FixCouple::make_properties() {
  bool own_fluid = false;
  fluid_ = property(fluid_property, coupling::fluid_state_doubles, true, own_fluid);
  drag_force_ = property("dragforce", 3, false, own_drag_force_);
  void_fraction_ = property("voidfraction", 1, false, own_void_fraction_);
  gas_velocity_ = property("uf", 3, false, own_gas_velocity_);
  if (gas_->with_heat()) {
    bool own_states = false;
    heat_states_ = property(heat_property, coupling::heat_state_doubles, true, own_states);
    gas_temperature_ = property(gas_temperature_property, 1, false, own_gas_temperature_);
  }
  host_->set_fluid(*fluid_);
}

void FixCouple::pre_delete(bool unfix) {
  if (!unfix || !fluid_)
    return;
  modify->delete_fix(fluid_property, true);
  if (heat_states_)
    modify->delete_fix(heat_property, true);
  for (const auto& [own, name] :
       {std::pair(own_drag_force_, "dragforce"), std::pair(own_void_fraction_, "voidfraction"),
        std::pair(own_gas_velocity_, "uf"),
        std::pair(own_gas_temperature_, gas_temperature_property)})
    if (own)
      modify->delete_fix(name, true);
}

void FixCouple::init() {
  driver::guard(*this, *error, [&] {
    check_script(driver::script_of(*lmp, rigid_fix_of(*lmp)));
    gas_->choose_effects(*host_);
    if (gas_->solves_gas() && !fluid_)
      make_properties();
  });
}

void FixCouple::setup(int) {
  driver::guard(*this, *error, [&] {
    host_->find_held();
    find_heat();
    find_who_looks();
    if (gas_->solves_gas())
      time_all_fixes();
    gas_->set_up(*host_, run_steps(), update->dt);
    fill_outputs();
    gas_->start_timers(); // LIGGGHTS' own begin after the set-up too
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

void FixCouple::find_who_looks() {
  outputs_are_looked_at_ = false;
  for (int i = 0; i < modify->nfix; ++i)
    outputs_are_looked_at_ = outputs_are_looked_at_ || may_look(*modify->fix[i]);
}

/// The table of post_run needs the seconds of each fix, from zero on.
void FixCouple::time_all_fixes() {
  timing_of_script_ = modify->timing;
  modify->timing = 1;
  for (int i = 0; i < modify->nfix; ++i)
    modify->fix[i]->reset_time_recording();
}

driver::RunSteps FixCouple::run_steps() const {
  return {.first = long(update->ntimestep), .last = long(update->laststep)};
}

/// All other forces of the step are in the force array here, and velocities are those of the
/// middle of the step.
void FixCouple::pre_final_integrate() {
  const particle_subset::Lap lap(particle_subset::work_times().gas);
  driver::guard(*this, *error, [&] {
    if (!gas_->running()) { // a run without set-up (`run N pre no`)
      if (gas_->solves_gas())
        time_all_fixes();
      find_who_looks();
      gas_->begin_run(run_steps());
    }
    const bool coupling_step = gas_->step(*host_, long(update->ntimestep), update->dt);
    if ((coupling_step && outputs_are_looked_at_) || update->ntimestep == output->next)
      fill_outputs();
  });
}

/// A pass over the states of all particles: only where somebody looks.
void FixCouple::fill_outputs() {
  if (!fluid_)
    return;
  const coupling::ParticleView view = host_->particles(false);
  const std::size_t n = view.size();
  const auto drag_force = driver::rows_of<Vec3>(drag_force_->array_atom, n);
  const auto gas_velocity = driver::rows_of<Vec3>(gas_velocity_->array_atom, n);
  particle_subset::for_each_subset(int(n), [&](particle_subset::Range range) {
    for (auto i = std::size_t(range.begin); i < std::size_t(range.end); ++i) {
      const coupling::FluidState& state = view.fluid[i];
      drag_force[i] = state.force;
      gas_velocity[i] = state.gas_velocity;
      void_fraction_->vector_atom[i] = state.void_fraction;
      if (gas_temperature_)
        gas_temperature_->vector_atom[i] = view.heat[i].gas_temperature;
    }
  });
}

void FixCouple::post_run() {
  if (!gas_->running())
    return;
  if (gas_->solves_gas())
    modify->timing = timing_of_script_;
  fill_outputs(); // a run that is asked to stop ends between two steps of output
  driver::RunTimes times;
  for (int i = 0; i < modify->nfix; ++i)
    if (modify->fix[i] != this)
      times.other_fixes += modify->fix[i]->get_recorded_time();
  times.other_fixes +=
      particle_subset::work_times().walls; // on threads LIGGGHTS does not time them
  times.contacts = timer->array[TIME_PAIR];
  times.neighbour_lists = timer->array[TIME_NEIGHBOR];
  times.communication = timer->array[TIME_COMM];
  times.output = timer->array[TIME_OUTPUT];
  times.total = timer->array[TIME_LOOP];
  const std::string report = gas_->end_run(times);
  if (update->ntimestep != update->firststep) // else no step was made: nothing to tell
    host_->say(report);
}

double FixCouple::compute_vector(int n) {
  return gas_->value(n);
}

int FixCouple::modify_param(int narg, char** arg) {
  if (narg < 2)
    return 0; // LIGGGHTS reports it
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

} // namespace granflux::liggghts
