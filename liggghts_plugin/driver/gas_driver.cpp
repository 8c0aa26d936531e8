// SPDX-FileCopyrightText: 2026 The GranFlux developers
// SPDX-License-Identifier: GPL-2.0-or-later

#include "gas_driver.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include <fmt/core.h>
#include <omp.h>

#include <granflux/cfd/error.hpp>
#include <granflux/cfd/read_gas_case.hpp>
#include <granflux/coupling/read_coupling.hpp>

namespace granflux::driver {

namespace {

constexpr double stiffness_limit = 1.5; // docs/theory_coupling.md, section 7
constexpr double half_kick = 0.5;       // of velocity Verlet: before and after the force

std::string last_good_state(const std::optional<GoodCheckpoint>& checkpoint) {
  return checkpoint ? fmt::format("last good state: checkpoint {} of step {}", checkpoint->file,
                                  checkpoint->step)
                    : "no state was kept: fix granflux/checkpoint keeps them";
}

/// Continues on one rank what it did before, up to the rounding of the next file's time.
constexpr double time_rounding = 1e-9;

} // namespace

GasDriver::GasDriver(std::span<char*> words, MPI_Comm comm)
    : comm_(comm), options_(read_couple_options(words)), clock_(options_.couple_every),
      progress_(options_.progress_every) {
  cfd::CaseFile file = cfd::CaseFile::read(options_.case_file, comm);
  gas_case_ = cfd::read_gas_case(file);
  coupling_options_ = coupling::read_coupling(file);
  file.finish();
  available_ = effects_of_case();
  const EffectsWanted& wanted = options_.effects;
  if (wanted.by == EffectsWanted::By::hand)
    for (const Effect effect : {Effect::convection, Effect::buoyancy})
      if (wanted.named.has(effect) && !available_.has(effect))
        throw ConfigError(fmt::format("effects {}: the case has {}", name_of(effect),
                                      effect == Effect::convection ? "no [energy] table"
                                                                   : "no [energy] expansion"));
  chosen_ = wanted.by != EffectsWanted::By::numbers;
  effects_ = available_;
  if (wanted.by == EffectsWanted::By::hand)
    keep_effects(wanted.named);
  stable_.emplace(gas_case_, coupling_options_);
}

EffectSet GasDriver::effects_of_case() const {
  EffectSet set{Effect::gas, Effect::drag, Effect::pressure_gradient, Effect::two_way};
  if (gas_case_.energy)
    set.add(Effect::convection);
  if (gas_case_.energy && gas_case_.energy->expansion > 0)
    set.add(Effect::buoyancy);
  return set;
}

/// What is off leaves the case: the gas never hears of it.
void GasDriver::keep_effects(EffectSet on) {
  effects_ = on;
  coupling_options_.effects = {.two_way = on.has(Effect::two_way),
                               .drag = on.has(Effect::drag),
                               .pressure_gradient = on.has(Effect::pressure_gradient)};
  if (!on.has(Effect::convection))
    gas_case_.energy.reset();
  else if (!on.has(Effect::buoyancy))
    gas_case_.energy->expansion = 0;
}

void GasDriver::describe(coupling::SceneState& scene) const {
  const cfd::Fluid& fluid = gas_case_.fluid;
  if (!solves_gas() && chosen_ && !watch_begun_)
    return; // off by hand
  coupling::GasOfScene gas{.density = fluid.density, .viscosity = fluid.viscosity};
  gas.speed = norm(gas_case_.initial_velocity);
  for (const cfd::BoundaryCondition& boundary : gas_case_.boundaries) {
    const double turning = norm(boundary.angular_velocity) * scene.particles.height / 2;
    const bool wall = boundary.kind == cfd::BoundaryKind::wall;
    double& speed = wall ? gas.wall_speed : gas.speed;
    speed = std::max({speed, norm(boundary.velocity), turning});
    if (gas_case_.energy && boundary.heat == cfd::BoundaryCondition::Heat::temperature)
      scene.meets(boundary.temperature);
    scene.heated = scene.heated || boundary.heat_flux != 0;
  }
  if (const auto& energy = gas_case_.energy) {
    gas.conductivity = energy->conductivity;
    gas.heat_capacity = energy->heat_capacity;
    gas.expansion = energy->expansion;
    scene.meets(energy->initial_temperature);
    for (const cfd::BoundaryCondition& boundary : gas_case_.boundaries)
      if (boundary.kind == cfd::BoundaryKind::inlet)
        scene.meets(boundary.temperature);
  }
  gas.coarse_graining = coupling_options_.coarse_graining;
  gas.length = scene.box_length;
  if (!(scene.gravity > 0))
    scene.gravity = norm(fluid.gravity);
  scene.gas = gas;
}

coupling::SceneState GasDriver::scene_state(Host& host) const {
  coupling::SceneState scene;
  host.describe(scene);
  describe(scene);
  if (coupler_) { // the gas is solved: its slip is known
    const coupling::ParticleView view = host.particles(false);
    add_slip(scene, view.velocity, view.fluid, comm_);
  }
  return scene;
}

void GasDriver::choose_effects(Host& host) {
  if (watch_begun_ || !options_.effects.given())
    return;
  const coupling::SceneState scene = scene_state(host);
  if (!chosen_)
    keep_effects(decide(scene, available_) & available_);
  stable_.emplace(gas_case_, coupling_options_);
  chosen_ = watch_begun_ = true;
  watch_ = EffectWatch(effects_of_gas, available_, effects_);
  watch_.begin(scene);
  host.say(effects_table(scene, effects_of_gas, available_, effects_));
}

void GasDriver::warn_of_neglected(Host& host, long step) {
  if (!options_.effects.given() || !watch_.due(step))
    return;
  if (const std::string text = watch_.warnings(scene_state(host)); !text.empty())
    host.say(text);
}

/// What the run is made of, so that a wrong unit shows before it starts.
std::string GasDriver::summary() const {
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
  if (coupling_options_.coarse_graining > 1)
    text += fmt::format("granflux: each particle is a parcel of {:g} particles, {:g} times their "
                        "diameter\n",
                        std::pow(coupling_options_.coarse_graining, 3),
                        coupling_options_.coarse_graining);
  for (const cfd::BoundaryCondition& boundary : gas_case_.boundaries)
    if (boundary.kind == cfd::BoundaryKind::inlet)
      text += fmt::format("granflux: inlet {}: {:g} {:g} {:g} m/s\n", boundary.name,
                          boundary.velocity.x, boundary.velocity.y, boundary.velocity.z);
  return text;
}

/// Errors in grid and boundaries show here only: they are those of the case file.
std::unique_ptr<coupling::Coupler> GasDriver::make_coupler() const {
  try {
    return std::make_unique<coupling::Coupler>(gas_case_, coupling_options_, comm_);
  } catch (const ConfigError& e) {
    throw ConfigError(options_.case_file + ": " + e.what());
  }
}

void GasDriver::load_restored(coupling::Coupler& coupler) const {
  try {
    load(*restored_, coupler);
  } catch (const ConfigError& e) { // on all ranks alike
    throw ConfigError(std::string("the gas of the restart file: ") + e.what());
  }
}

/// Before the first run: the gas at its initial or restored state, the particles where they are.
void GasDriver::begin(Host& host, double dt) {
  const Scene scene = host.scene();
  if (const std::string note = settle_gravity(scene, gas_case_.fluid); !note.empty())
    host.say(fmt::format("granflux: {}\n", note));

  auto coupler = make_coupler();
  stable_->set_mesh(coupler->mesh(), coupler->gas());
  const coupling::ParticleView particles = host.particles(true);
  stable_->look(host, particles, dt, clock_.every() * dt, comm_);
  if (!options_.any_box)
    check_box(scene, coupler->extent(), coupler->mesh().lattice.has_value());
  if (restored_) {
    const CoupleState& state = restored_->state;
    load_restored(*coupler);
    const bool follows = gas_case_.numerics.courant > 0;
    clock_.restore(state.time_step, follows ? int(state.steps) : clock_.every(),
                   long(state.steps_left), state.owed);
    last_force_dt_ = state.time_step;
    next_fields_time_ = state.next_fields_time;
  } else {
    coupler->initialise(particles, 0);
  }
  if (!gas_case_.output.fields.empty())
    fields_ =
        std::make_unique<cfd::CgnsWriter>(coupler->mesh(), gas_case_.output.fields,
                                          restored_ ? long(restored_->state.fields_written) : 0);
  coupler_ = std::move(coupler);
  host.say(summary());
  if (!restored_)
    write_fields();
  restored_.reset();
}

void GasDriver::set_up(Host& host, RunSteps steps, double dt) {
  if (!solves_gas()) {
    clock_.set_time_step(dt);
    begin_run(steps);
    return;
  }
  explaining(host, steps.first, [&] {
    stable_->begin_run(host);
    if (!coupler_)
      begin(host, dt);
  });
  begin_run(steps);
  clock_.set_time_step(dt);
  // Those of the last step come back, and its impulses are in the books.
  const bool forces_are_known = host.forces_come_back();

  // The last run ended, or its restart file was written, with a force whose second half the
  // integrator never applied: the host has just computed all forces anew.
  if (last_force_dt_ > 0 && !forces_are_known)
    coupler_->unapply(host.particles(false), last_force_dt_, half_kick);
  if (clock_.due() && !forces_are_known)
    exchange(host, steps.first);
  else
    explaining(host, steps.first, [&] { look(host, host.particles(true)); });
  host.say(stable_->table());
  warn_of_limits(host);
  if (!forces_are_known)
    apply(host, half_kick);
}

void GasDriver::begin_run(RunSteps steps) {
  if (!coupler_ && solves_gas())
    throw ConfigError("the first run with the gas must be set up: 'run N' without 'pre no'");
  running_ = true;
  steps_ = steps;
  largest_ = {};
  start_timers();
}

void GasDriver::start_timers() {
  if (!coupler_)
    return;
  times_at_start_ = coupler_->times();
  numbers_sent_at_start_ = coupler_->numbers_sent();
  fields_seconds_ = particle_steps_ = 0;
  progress_.start(steps_.first, steps_.last, MPI_Wtime());
}

bool GasDriver::step(Host& host, long step, double dt) {
  if (!solves_gas()) {
    clock_.count_step();
    if (!clock_.due())
      return false;
    clock_.advanced();
    warn_of_neglected(host, step);
    return true;
  }
  if (dt != clock_.time_step())
    throw ConfigError(fmt::format("the time step changed from {} to {} s within a run: it must be "
                                  "constant (no fix dt/reset)",
                                  clock_.time_step(), dt));
  // Up to here with the gas that was ahead: an interval has all its steps before the next.
  if (with_heat())
    coupler_->received_heat(host.step_temperatures());
  clock_.count_step();
  const bool coupling_step = clock_.due();
  if (coupling_step)
    exchange(host, step);
  apply(host, 1);
  if (coupling_step)
    if (const std::string line = progress_.line(step, coupler_->gas().time(), MPI_Wtime());
        !line.empty())
      host.say(line);
  return coupling_step;
}

/// Whether the particles are to be believed, before they meet the gas.
void GasDriver::look(Host& host, const coupling::ParticleView& particles) {
  stable_->look(host, particles, clock_.time_step(), clock_.interval(), comm_);
}

void GasDriver::exchange(Host& host, long step) {
  explaining(host, step, [&] {
    follow_courant();
    const coupling::ParticleView particles = host.particles(true);
    look(host, particles);
    stable_->follow(coupler_->exchange(particles, clock_.interval()));
  });
  clock_.advanced();
  if (step > steps_.first) // else after the table
    warn_of_limits(host);
  largest_.add(coupler_->report(), coupler_->gas().balance());
  warn_of_neglected(host, step);
  write_fields();
}

/// Where the case says so, the gas step is as long as the gas itself allows.
void GasDriver::follow_courant() {
  const double courant = gas_case_.numerics.courant;
  if (courant > 0)
    clock_.keep_within(courant / coupler_->gas().courant_rate());
}

/// Each number once: what is beyond its limit is not to be trusted from here on.
void GasDriver::warn_of_limits(Host& host) {
  for (const std::string& warning : stable_->new_warnings())
    host.say(fmt::format("granflux: WARNING: {}\n", warning));
}

/// Runs what may fail on all ranks alike, and adds to the error the step and the likely cause.
template <class Work> void GasDriver::explaining(Host& host, long step, Work&& work) {
  try {
    work();
  } catch (const NumericalError& error) {
    warn_of_limits(host);
    throw NumericalError(fmt::format("step {}: {}; {}; {}", step, error.what(),
                                     stable_->likely_cause(),
                                     last_good_state(host.last_checkpoint())));
  }
}

void GasDriver::apply(Host& host, double share) {
  const coupling::ParticleView particles = host.particles(false);
  if (coupling_options_.effects.any_force()) {
    coupler_->apply(particles, clock_.time_step(), share);
    host.clear_frozen_forces();
  }
  last_force_dt_ = clock_.time_step();
  particle_steps_ += double(particles.size());
}

void GasDriver::write_fields() {
  const double every = gas_case_.output.every, time = coupler_->gas().time();
  if (!fields_ || time < next_fields_time_ - time_rounding * every)
    return;
  const double start = MPI_Wtime();
  fields_->write(coupler_->gas());
  while (next_fields_time_ <= time + time_rounding * every)
    next_fields_time_ += every;
  fields_seconds_ += MPI_Wtime() - start;
}

/// Of this rank and run.
coupling::CouplingTimes GasDriver::coupling_times() const {
  const coupling::CouplingTimes now = coupler_->times();
  return {.gas = now.gas - times_at_start_.gas,
          .locate = now.locate - times_at_start_.locate,
          .deposit = now.deposit - times_at_start_.deposit,
          .sample = now.sample - times_at_start_.sample,
          .messages = now.messages - times_at_start_.messages,
          .force = now.force - times_at_start_.force,
          .laws = now.laws - times_at_start_.laws};
}

double GasDriver::seconds() const {
  if (!coupler_)
    return 0;
  const coupling::CouplingTimes t = coupling_times();
  return t.gas + t.locate + t.deposit + t.sample + t.messages + t.force + fields_seconds_;
}

std::string GasDriver::end_run(RunTimes times) {
  running_ = false;
  if (!coupler_)
    return "granflux: the gas was not solved\n";
  times.coupling = coupling_times();
  times.fields = fields_seconds_;
  double particle_steps = particle_steps_;
  MPI_Allreduce(MPI_IN_PLACE, &particle_steps, 1, MPI_DOUBLE, MPI_SUM, comm_);
  const RunTimesOverRanks over = over_ranks(times, comm_);
  return run_report(over, largest_, particle_steps) + effects_report(over.mean, particle_steps) +
         division_report(gas_share(), comm_);
}

/// What the effects that are on have taken of this run.
std::string GasDriver::effects_report(const RunTimes& mean, double particle_steps) const {
  if (!options_.effects.given() || particle_steps == 0)
    return {};
  std::string text = "granflux: measured cost of the effects that are on, ns a particle and step\n";
  const auto row = [&](const char* name, double seconds) {
    text += fmt::format("  {:<42}{:>11.2f}\n", name, 1e9 * seconds / particle_steps);
  };
  const coupling::CouplingTimes& c = mean.coupling;
  row("gas", c.gas);
  if (coupling_options_.effects.any_force())
    row(effects_.has(Effect::drag)
            ? effects_.has(Effect::pressure_gradient) ? "drag, pressure_gradient" : "drag"
            : "pressure_gradient",
        c.force);
  row(effects_.has(Effect::two_way) ? "exchange, two_way" : "exchange, one way",
      c.locate + c.deposit + c.messages + c.sample);
  row(effects_.has(Effect::convection) ? "laws of drag and convection" : "laws of drag", c.laws);
  return text;
}

GasShare GasDriver::gas_share() const {
  GasShare share{.threads = omp_get_max_threads()};
  for (const cfd::Block& block : coupler_->mesh().local)
    share.cells += double(block.layout.cells[0]) * block.layout.cells[1] * block.layout.cells[2];
  const auto steps = double(std::max(1L, largest_.exchanges));
  share.numbers_sent = double(coupler_->numbers_sent() - numbers_sent_at_start_) / steps;
  return share;
}

/// Mean dynamic pressure on the first inlet of the case minus that on its first outlet [Pa].
double GasDriver::pressure_drop() {
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

double GasDriver::value(int n) {
  if (!coupler_)
    return 0; // before the first run
  if (n == 0)
    return pressure_drop();
  const coupling::ExchangeReport& report = coupler_->report();
  const coupling::CouplingTimes& times = coupler_->times();
  const cfd::Balance& balance = coupler_->gas().balance();
  const std::array<double, values - 1> others{
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
  return others[std::size_t(n) - 1];
}

bool GasDriver::modify(std::string_view key, const char* value) {
  if (key == "couple_every")
    clock_.set_every(read_couple_every(value));
  else if (key == "progress")
    progress_.set_every(read_progress_every(value));
  else
    return false;
  return true;
}

void GasDriver::write_state(std::FILE* file) const {
  if (!coupler_)
    return write_couple_state(restored_, file, comm_);
  const CoupleState state{.time_step = clock_.time_step(),
                          .steps = double(clock_.steps()),
                          .steps_left = double(clock_.steps_left()),
                          .owed = clock_.owed(),
                          .next_fields_time = next_fields_time_,
                          .fields_written = fields_ ? double(fields_->next()) : 0};
  write_couple_state(state, *coupler_, file, comm_);
}

void GasDriver::read_state(const char* block) {
  try {
    restored_ = read_couple_state(block, comm_);
  } catch (const ConfigError& e) { // on all ranks alike
    throw ConfigError(std::string("the gas of the restart file: ") + e.what());
  }
}

void GasDriver::check_state_fits() const {
  check_block_fits(*coupler_);
}

} // namespace granflux::driver
