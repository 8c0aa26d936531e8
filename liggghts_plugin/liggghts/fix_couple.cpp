// SPDX-FileCopyrightText: 2026 The GranFlux developers
// SPDX-License-Identifier: GPL-2.0-or-later

#include "fix_couple.hpp"

#include <algorithm>
#include <array>
#include <cstdio>
#include <string_view>
#include <utility>
#include <vector>

#include <fmt/core.h>
#include <mpi.h>

#include <liggghts/lammps.h>

#include <liggghts/atom.h>
#include <liggghts/comm.h>
#include <liggghts/error.h>
#include <liggghts/fix_property_atom.h>
#include <liggghts/group.h>
#include <liggghts/modify.h>
#include <liggghts/output.h>
#include <liggghts/timer.h>
#include <liggghts/update.h>

#include <granflux/cfd/error.hpp>
#include <granflux/cfd/read_gas_case.hpp>
#include <granflux/coupling/read_coupling.hpp>

#include "gas_box.hpp"
#include "particle_subset/work_times.hpp"

namespace granflux::liggghts {

namespace {

constexpr int vector_length = 36; // entries of compute_vector
constexpr char fluid_property[] = "granflux_fluid";
constexpr char heat_property[] = "granflux_heat_state";
constexpr char gas_temperature_property[] = "gasTemperature";
constexpr double stiffness_limit = 1.5; // docs/theory_coupling.md, section 7
constexpr double half_kick = 0.5;       // of velocity Verlet: before and after the force

/// Continues on one rank what it did before, up to the rounding of the next file's time.
constexpr double time_rounding = 1e-9;

} // namespace

template <class Work> void FixCouple::guard(Work&& work) {
  const auto text = [this](const std::exception& e) {
    return fmt::format("fix {} granflux/couple: {}", id, e.what());
  };
  try {
    work();
  } catch (const ConfigError& e) {
    error->all(FLERR, text(e).c_str()); // thrown on all ranks alike
  } catch (const NumericalError& e) {
    error->all(FLERR, text(e).c_str()); // likewise
  } catch (const std::exception& e) {
    error->one(FLERR, text(e).c_str());
  }
}

FixCouple::FixCouple(LAMMPS_NS::LAMMPS* lammps, int narg, char** arg)
    : Fix(lammps, narg, arg), clock_(1), progress_(0) {
  restart_global = 1;
  vector_flag = 1;
  size_vector = vector_length;
  global_freq = 1;
  extvector = 0;
  guard([&] {
    refuse_second_fix();
    options_ = read_couple_options({arg + 3, std::size_t(narg - 3)});
    if (!options_.fixed_group.empty() && group->find(options_.fixed_group.c_str()) < 0)
      throw ConfigError(fmt::format("fixed_group {}: no such group", options_.fixed_group));
    read_case();
  });
  clock_ = CoupleClock(options_.couple_every);
  progress_.set_every(options_.progress_every);
}

void FixCouple::refuse_second_fix() const {
  for (int i = 0; i < modify->nfix; ++i)
    if (const Fix* other = modify->fix[i]; other && std::string_view(other->style) == style)
      throw ConfigError(fmt::format("fix {} is one already: there can be one gas only", other->id));
}

void FixCouple::read_case() {
  cfd::CaseFile file = cfd::CaseFile::read(options_.case_file, world);
  gas_case_ = cfd::read_gas_case(file);
  coupling_options_ = coupling::read_coupling(file);
  file.finish();
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
  bool own_fluid = false;
  fluid_ = property(fluid_property, coupling::fluid_state_doubles, true, own_fluid);
  drag_force_ = property("dragforce", 3, false, own_drag_force_);
  void_fraction_ = property("voidfraction", 1, false, own_void_fraction_);
  gas_velocity_ = property("uf", 3, false, own_gas_velocity_);
  if (gas_case_.energy) {
    bool own_states = false;
    heat_states_ = property(heat_property, coupling::heat_state_doubles, true, own_states);
    gas_temperature_ = property(gas_temperature_property, 1, false, own_gas_temperature_);
  }
  const int held =
      options_.fixed_group.empty() ? 0 : group->bitmask[group->find(options_.fixed_group.c_str())];
  host_ = std::make_unique<HostView>(lmp, *fluid_, groupbit, held);
}

void FixCouple::pre_delete(bool unfix) {
  if (!unfix)
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

void FixCouple::say(const std::string& text) const {
  if (comm->me != 0)
    return;
  for (FILE* out : {screen, logfile})
    if (out) {
      std::fputs(text.c_str(), out);
      std::fflush(out);
    }
}

void FixCouple::init() {
  guard([&] { check_script(*lmp); });
}

/// What the run is made of, so that a wrong unit shows before it starts.
std::string FixCouple::summary() const {
  const cfd::Fluid& fluid = gas_case_.fluid;
  const cfd::Mesh& mesh = coupler_->mesh();
  std::string cells;
  if (mesh.lattice) {
    const cfd::Index3 n = mesh.lattice->cells();
    cells = fmt::format("{} x {} x {} cells", n[0], n[1], n[2]);
  } else {
    long count = 0;
    for (const cfd::BlockInfo& block : mesh.blocks)
      count += long(block.cells[0]) * block.cells[1] * block.cells[2];
    cells = fmt::format("{} cells in {} blocks", count, mesh.blocks.size());
  }
  std::string text =
      fmt::format("granflux: gas of {:g} kg/m3 and {:g} Pa s on {}; "
                  "gravity {:g} {:g} {:g} m/s2; "
                  "drag {}, void fraction {}, model {}\n",
                  fluid.density, fluid.viscosity, cells, fluid.gravity.x, fluid.gravity.y,
                  fluid.gravity.z, coupling_options_.drag, coupling_options_.void_fraction,
                  coupling_options_.model == coupling::MomentumModel::a ? "a" : "b");
  for (const cfd::BoundaryCondition& boundary : gas_case_.boundaries)
    if (boundary.kind == cfd::BoundaryKind::inlet)
      text += fmt::format("granflux: inlet {}: {:g} {:g} {:g} m/s\n", boundary.name,
                          boundary.velocity.x, boundary.velocity.y, boundary.velocity.z);
  return text;
}

/// Errors in grid and boundaries show here only: they are those of the case file.
std::unique_ptr<coupling::Coupler> FixCouple::make_coupler() const {
  try {
    return std::make_unique<coupling::Coupler>(gas_case_, coupling_options_, world);
  } catch (const ConfigError& e) {
    throw ConfigError(options_.case_file + ": " + e.what());
  }
}

/// Before the first run: the gas at its initial or restored state, the particles where they are.
void FixCouple::begin() {
  if (const std::string note = settle_gravity(*lmp, gas_case_.fluid); !note.empty())
    say(fmt::format("granflux: {}\n", note));

  auto coupler = make_coupler();
  if (!options_.any_box)
    check_box(*lmp, coupler->extent(), coupler->mesh().lattice.has_value(),
              2 * largest_radius(*lmp));
  if (restored_) {
    coupler->load(restored_->coupler);
    clock_.restore(restored_->time_step, restored_->steps_left, restored_->owed);
    last_force_dt_ = restored_->time_step;
    next_fields_time_ = restored_->next_fields_time;
  } else {
    coupler->initialise(host_->particles(true), 0);
  }
  if (!gas_case_.output.fields.empty())
    fields_ = std::make_unique<cfd::CgnsWriter>(coupler->mesh(), gas_case_.output.fields,
                                                restored_ ? restored_->fields_written : 0);
  coupler_ = std::move(coupler);
  say(summary());
  if (!restored_)
    write_fields();
  restored_.reset();
}

void FixCouple::setup(int) {
  guard([&] {
    host_->find_held();
    find_heat();
    if (!coupler_)
      begin();
    start_run();
    clock_.set_time_step(update->dt);

    // The last run ended, or its restart file was written, with a force whose second half the
    // integrator never applied: LIGGGHTS has just computed all forces anew.
    if (last_force_dt_ > 0)
      coupler_->unapply(host_->particles(false), last_force_dt_, half_kick);
    if (clock_.due())
      exchange();
    apply(half_kick);
    fill_outputs();
    start_timers(); // LIGGGHTS' own begin after the set-up too
  });
}

/// Where the gas has a temperature, those of the particles are integrated together with it.
void FixCouple::find_heat() {
  if (!gas_case_.energy)
    return;
  heat_ = nullptr;
  for (int i = 0; i < modify->nfix; ++i)
    if (auto* heat = dynamic_cast<FixHeat*>(modify->fix[i]))
      heat_ = heat;
  if (!heat_)
    throw ConfigError("the case has an [energy] table, but particles have no temperature: define "
                      "fix granflux/heat");
  heat_->leave_steps_to_gas();
  host_->set_heat(heat_, heat_states_);
}

/// Counts from zero; also at the first step of a run without set-up (`run N pre no`).
void FixCouple::start_run() {
  running_ = true;
  largest_ = {};
  timing_of_script_ = modify->timing;
  modify->timing = 1; // the table of post_run needs the seconds of each fix
  for (int i = 0; i < modify->nfix; ++i)
    modify->fix[i]->reset_time_recording();
  start_timers();
}

void FixCouple::start_timers() {
  times_at_start_ = coupler_->times();
  fields_seconds_ = particle_steps_ = 0;
  progress_.start(long(update->ntimestep), long(update->laststep), MPI_Wtime());
}

/// All other forces of the step are in the force array here, and velocities are those of the
/// middle of the step.
void FixCouple::pre_final_integrate() {
  guard([&] {
    if (!running_)
      start_run();
    if (update->dt != clock_.time_step())
      throw ConfigError(
          fmt::format("the time step changed from {} to {} s within a run: it must be "
                      "constant (no fix dt/reset)",
                      clock_.time_step(), update->dt));
    // Up to here with the gas that was ahead: an interval has all its steps before the next.
    if (heat_)
      coupler_->received_heat(heat_->step_with_gas(host_->heat_states()));
    clock_.count_step();
    const bool coupling_step = clock_.due();
    if (coupling_step)
      exchange();
    apply(1);
    particle_steps_ += atom->nlocal;
    if (coupling_step || update->ntimestep == output->next)
      fill_outputs();
    if (coupling_step)
      if (const std::string line =
              progress_.line(long(update->ntimestep), coupler_->gas().time(), MPI_Wtime());
          !line.empty())
        say(line);
  });
}

void FixCouple::exchange() {
  const coupling::ExchangeReport& report =
      coupler_->exchange(host_->particles(true), clock_.interval());
  clock_.advanced();
  warn_if_stiff(report.stiffness_max);
  largest_.add(report, coupler_->gas().balance());
  write_fields();
}

/// Once: the gas of a packed bed that is not marked as fixed is then not stable.
void FixCouple::warn_if_stiff(double stiffness) {
  if (stiffness <= stiffness_limit || warned_of_stiffness_)
    return;
  warned_of_stiffness_ = true;
  say(fmt::format(
      "granflux: WARNING: the coupling interval is {:.3g} times the response time of "
      "the quickest particle; above {} gas in a packed bed that contacts hold may not "
      "be stable: lower couple_every to {} or less, or name held particles by "
      "fixed_group\n",
      stiffness, stiffness_limit,
      std::max(1, int(clock_.interval() / clock_.time_step() * stiffness_limit / stiffness))));
}

void FixCouple::apply(double share) {
  coupler_->apply(host_->particles(false), clock_.time_step(), share);
  host_->clear_frozen_forces();
  last_force_dt_ = clock_.time_step();
}

void FixCouple::write_fields() {
  const double every = gas_case_.output.every, time = coupler_->gas().time();
  if (!fields_ || time < next_fields_time_ - time_rounding * every)
    return;
  const double start = MPI_Wtime();
  fields_->write(coupler_->gas());
  while (next_fields_time_ <= time + time_rounding * every)
    next_fields_time_ += every;
  fields_seconds_ += MPI_Wtime() - start;
}

void FixCouple::fill_outputs() {
  const coupling::ParticleView view = host_->particles(false);
  for (std::size_t i = 0; i < view.size(); ++i) {
    const coupling::FluidState& state = view.fluid[i];
    for (int d = 0; d < 3; ++d) {
      drag_force_->array_atom[i][d] = state.force[d];
      gas_velocity_->array_atom[i][d] = state.gas_velocity[d];
    }
    void_fraction_->vector_atom[i] = state.void_fraction;
    if (heat_)
      gas_temperature_->vector_atom[i] = view.heat[i].gas_temperature;
  }
}

void FixCouple::post_run() {
  if (!running_)
    return;
  running_ = false;
  modify->timing = timing_of_script_;
  if (update->ntimestep == update->firststep)
    return; // no step was made: nothing to tell
  RunTimes times;
  const coupling::CouplingTimes now = coupler_->times();
  times.coupling.gas = now.gas - times_at_start_.gas;
  times.coupling.locate = now.locate - times_at_start_.locate;
  times.coupling.deposit = now.deposit - times_at_start_.deposit;
  times.coupling.sample = now.sample - times_at_start_.sample;
  times.coupling.messages = now.messages - times_at_start_.messages;
  times.coupling.force = now.force - times_at_start_.force;
  times.fields = fields_seconds_;
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

  double particle_steps = particle_steps_;
  MPI_Allreduce(MPI_IN_PLACE, &particle_steps, 1, MPI_DOUBLE, MPI_SUM, world);
  say(run_report(mean_over_ranks(times, world), largest_, particle_steps));
}

/// Mean dynamic pressure on the first inlet of the case minus that on its first outlet [Pa].
double FixCouple::pressure_drop() {
  const auto first = [&](cfd::BoundaryKind kind) -> const cfd::BoundaryCondition* {
    for (const cfd::BoundaryCondition& b : gas_case_.boundaries)
      if (b.kind == kind)
        return &b;
    return nullptr;
  };
  const auto *inlet = first(cfd::BoundaryKind::inlet), *outlet = first(cfd::BoundaryKind::outlet);
  if (!inlet || !outlet)
    return 0;
  return coupler_->gas().boundary_pressure(inlet->name) -
         coupler_->gas().boundary_pressure(outlet->name);
}

double FixCouple::compute_vector(int n) {
  if (!coupler_)
    return 0; // before the first run
  if (n == 0)
    return pressure_drop();
  const coupling::ExchangeReport& report = coupler_->report();
  const coupling::CouplingTimes& times = coupler_->times();
  const cfd::Balance& balance = coupler_->gas().balance();
  const std::array<double, vector_length - 1> values{
      report.drag.x,
      report.drag.y,
      report.drag.z,
      report.pressure_force.x,
      report.pressure_force.y,
      report.pressure_force.z,
      report.void_fraction_min,
      report.particle_volume,
      report.volume_residual,
      report.momentum_residual,
      relative_continuity_residual(report.gas),
      relative_momentum_residual(balance),
      coupler_->gas().time(),
      report.gas.courant,
      double(report.particles),
      double(report.outside),
      double(report.law_out_of_range),
      report.slip_reynolds_max,
      double(report.gas.pressure_iterations),
      double(coupler_->gas().steps()),
      balance.momentum.x,
      balance.momentum.y,
      balance.momentum.z,
      times.gas,
      times.locate + times.deposit + times.sample + times.messages,
      times.force,
      report.budget_residual,
      report.stiffness_max,
      report.heat_rate,
      relative_heat_residual(balance),
      report.heat_residual,
      report.heat_stiffness_max,
      double(report.nusselt_out_of_range),
      balance.heat_convection,
      balance.heat_conduction,
  };
  return values[std::size_t(n) - 1];
}

int FixCouple::modify_param(int narg, char** arg) {
  const std::string_view key = arg[0];
  if (narg < 2 || (key != "couple_every" && key != "progress"))
    return 0; // LIGGGHTS reports it
  guard([&] {
    if (key == "couple_every")
      clock_.set_every(read_couple_every(arg[1]));
    else
      progress_.set_every(read_progress_every(arg[1]));
  });
  return 2;
}

void FixCouple::write_restart(FILE* file) {
  guard([&] {
    CoupleState state;
    if (coupler_) {
      state.time_step = clock_.time_step();
      state.steps_left = clock_.steps_left();
      state.owed = clock_.owed();
      state.next_fields_time = next_fields_time_;
      state.fields_written = fields_ ? fields_->next() : 0;
      state.coupler = coupler_->save();
    } else if (restored_) {
      state = *restored_;
    }
    write_couple_state(state, file, world);
  });
}

void FixCouple::restart(char* block) {
  guard([&] {
    CoupleState state = read_couple_state(block, world);
    if (state.time_step > 0) // else written before the first run: nothing to continue
      restored_ = std::move(state);
  });
}

} // namespace granflux::liggghts
