// SPDX-FileCopyrightText: 2026 The GranFlux developers
// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <mpi.h>
#include <optional>
#include <string>
#include <vector>

#include <fmt/core.h>

#include <granflux/coupling/particle_view.hpp>

#include "effects.hpp"
#include "fixes_of_run.hpp"
#include "guard.hpp"
#include "heat_books.hpp"
#include "heat_every.hpp"
#include "heat_options.hpp"
#include "heat_report.hpp"
#include "say.hpp"
#include "scene_of_script.hpp"

namespace granflux::driver {

/// fix ID all granflux/heat initial_temperature T ...: what is the same in every host of books and
/// report, of the choice of effects, and beside the gas. Written once over the classes of a host,
/// which have the same names in all of them: `HostFix` is its class Fix, `Couple` its fix of the
/// gas. How contacts bring heat is the host's own.
template <class HostFix, class Couple> class HeatFix : public HostFix {
public:
  template <class Lammps>
  HeatFix(Lammps* lammps, int narg, char** arg) : HostFix(lammps, narg, arg) {
    this->restart_global = 1;
    this->scalar_flag = this->vector_flag = 1;
    this->size_vector = HeatReport::values;
    this->global_freq = 1;
    this->extscalar = 1;
    this->extvector = 0;
    guarded([&] {
      refuse_second_fix(*this->modify, this->style, "");
      if (this->igroup != 0)
        throw ConfigError(fmt::format("group {}: must be all; fixed_temperature names groups whose "
                                      "temperatures stay",
                                      this->group->names[this->igroup]));
    });
  }

  void post_run() override;
  /// Heat of all particles, sum of m c T [J].
  double compute_scalar() override {
    look_at_temperatures();
    return report_.heat();
  }
  double compute_vector(int n) override {
    look_at_temperatures();
    return report_.value(n);
  }
  void write_restart(std::FILE* file) override {
    guarded([&] { write_heat_books(books_, heat_at_start_, file, this->world); });
  }
  void restart(char* block) override {
    guarded([&] { books_ = read_heat_books(block, heat_at_start_, this->world); });
  }

  /// In each run between init() and the first step: the gas brings about the steps of temperature
  /// itself, by step_with_gas().
  /// `couple_every`: time steps between two exchanges with it, 0 where their number changes.
  void leave_steps_to_gas(int couple_every) {
    check_heat_every_with_gas(options().every, couple_every);
    steps_by_gas_ = true;
  }
  /// The step of this time step; returns the heat that this rank's particles took from the gas [J]:
  /// none where temperatures take no step. `states`: of the owned particles.
  double step_with_gas(coupling::HeatState* states) {
    step(states);
    return steps_now() ? step_of_temperature() * powers_.convection : 0;
  }
  /// Temperatures and heat capacities of the owned particles, and which stay as they are.
  void show_to_gas(coupling::ParticleView& view);
  /// Adds what particles conduct and radiate, and the temperatures of particles and walls.
  /// Collective.
  virtual void describe(coupling::SceneState& scene) = 0;

protected:
  [[nodiscard]] virtual const HeatOptions& options() const = 0;
  /// Of the particles of this rank; without capacities before the first run.
  [[nodiscard]] virtual WarmParticles particles() const = 0;
  /// Where there is conduction.
  [[nodiscard]] virtual std::optional<HeatReport::Conduction> conduction() const = 0;
  [[nodiscard]] virtual std::optional<Vec3> gravity() const = 0;
  /// The line that says how contacts bring heat.
  [[nodiscard]] virtual std::string method() const = 0;
  /// The others are off from here on.
  virtual void keep(EffectSet on) = 0;
  virtual void step(coupling::HeatState* gas) = 0;

  template <class Work> void guarded(Work&& work) { guard(*this, *this->error, work); }
  /// When the words are read.
  void check_groups() const;
  /// Before a run: leaves to the numbers what the words leave to them, before the first one with
  /// particles; what is of fixed temperature; the gas speaks up anew.
  void begin_run();
  /// When particles are where they begin.
  void open_books();
  /// In every step, unless the gas brings it about.
  void step_alone();
  /// Whether it looks at the scene in that step, for what has become of effects that are off.
  [[nodiscard]] bool looks_at_scene(long step) const {
    return options().effects.given() && watch_.would_be_due(step);
  }
  /// Of this step of temperature of `dt` seconds, but what goes into walls.
  void book(const HeatPowers& powers, double dt) {
    powers_ = powers;
    HeatPowers received = powers;
    received.to_walls = 0;
    books_.book(received, dt);
  }
  /// In every time step: it is in no temperature.
  void book_for_walls(double power, double dt) { books_.to_walls += dt * power; }
  /// Temperatures take a step in this time step, of step_of_temperature() seconds: by the number of
  /// the time step alone, which a restart file knows.
  [[nodiscard]] bool steps_now() const { return this->update->ntimestep % options().every == 0; }
  [[nodiscard]] double step_of_temperature() const { return options().every * this->update->dt; }
  /// Before a run. `contact_times`: gives those of the host; collective.
  void check_heat_every(auto&& contact_times);
  /// `number`: of time steps in the time in which contacts would take a particle to the
  /// temperature around it, the least of all.
  void refuse_long_step(double number) const;
  /// Temperatures were set.
  void look_again() { looked_at_ = -1; }

  /// Temperatures stay as they are: chosen so, and no gas changes them.
  [[nodiscard]] bool rests() const {
    return options().effects.given() && !options().available().any() && !steps_by_gas_;
  }
  [[nodiscard]] bool steps_by_gas() const { return steps_by_gas_; }
  [[nodiscard]] int held() const { return held_; } ///< bits of the groups of fixed temperature

private:
  void choose_effects();
  [[nodiscard]] coupling::SceneState scene();
  void warn_of_neglected();
  void look_at_temperatures();

  EffectSet available_; ///< of the words
  bool chosen_ = false; ///< effects are, and the table is printed
  EffectWatch watch_;
  int held_ = 0;
  bool steps_by_gas_ = false;
  std::vector<double> heat_capacity_; ///< of each particle [J/K]
  std::vector<std::uint8_t> is_held_;

  bool said_ = false;                   ///< what is in use
  std::optional<double> heat_at_start_; ///< of all ranks when the books were opened [J]
  HeatPowers powers_;                   ///< of the last step, this rank
  HeatBooks books_;                     ///< of this rank
  HeatReport report_;
  long looked_at_ = -1; ///< step of report_
};

template <class HostFix, class Couple> void HeatFix<HostFix, Couple>::check_groups() const {
  for (const std::string& name : options().fixed_groups)
    if (this->group->find(name.c_str()) < 0)
      throw ConfigError(fmt::format("fixed_temperature {}: no such group", name));
}

template <class HostFix, class Couple>
void HeatFix<HostFix, Couple>::check_heat_every(auto&& contact_times) {
  if (options().every == 1)
    return;
  double fastest = 0;
  for (int i = 0; i < this->atom->nlocal; ++i) {
    const double* v = this->atom->v[i];
    fastest = std::max(fastest, std::hypot(v[0], v[1], v[2]));
  }
  MPI_Allreduce(MPI_IN_PLACE, &fastest, 1, MPI_DOUBLE, MPI_MAX, this->world);
  say(*this->lmp,
      driver::check_heat_every(options().every, this->update->dt, contact_times(), fastest));
}

template <class HostFix, class Couple> void HeatFix<HostFix, Couple>::begin_run() {
  choose_effects();
  held_ = 0;
  for (const std::string& name : options().fixed_groups)
    held_ |= this->group->bitmask[this->group->find(name.c_str())];
  steps_by_gas_ = false;
}

template <class HostFix, class Couple> void HeatFix<HostFix, Couple>::choose_effects() {
  if (chosen_)
    return;
  chosen_ = true;
  available_ = options().available();
  if (!options().effects.given())
    return;
  const coupling::SceneState found = scene();
  if (options().effects.by == EffectsWanted::By::numbers)
    keep(decide(found, available_));
  const EffectSet on = options().available();
  watch_ = EffectWatch(effects_of_heat, available_, on);
  watch_.begin(found);
  say(*this->lmp, effects_table(found, effects_of_heat, available_, on));
}

template <class HostFix, class Couple> coupling::SceneState HeatFix<HostFix, Couple>::scene() {
  coupling::SceneState scene;
  describe_particles(*this->lmp, gravity(), scene);
  describe(scene);
  if (const auto* couple = find_fix<Couple>(*this->modify))
    couple->describe(scene);
  return scene;
}

template <class HostFix, class Couple> void HeatFix<HostFix, Couple>::warn_of_neglected() {
  if (options().effects.given())
    say(*this->lmp, watch_.warnings(scene()));
}

template <class HostFix, class Couple> void HeatFix<HostFix, Couple>::open_books() {
  if (!heat_at_start_) {
    double heat = heat_of(particles());
    MPI_Allreduce(MPI_IN_PLACE, &heat, 1, MPI_DOUBLE, MPI_SUM, this->world);
    heat_at_start_ = heat;
  }
  if (!said_)
    say(*this->lmp, method());
  said_ = true;
}

template <class HostFix, class Couple> void HeatFix<HostFix, Couple>::step_alone() {
  if (!steps_by_gas_ && !rests())
    step(nullptr);
  if (options().effects.given() && watch_.due(long(this->update->ntimestep)))
    guarded([&] { warn_of_neglected(); });
}

template <class HostFix, class Couple>
void HeatFix<HostFix, Couple>::show_to_gas(coupling::ParticleView& view) {
  const WarmParticles warm = particles();
  const std::size_t n = warm.temperature.size();
  heat_capacity_.resize(n);
  for (std::size_t i = 0; i < n; ++i)
    heat_capacity_[i] = warm.mass[i] * warm.capacity[std::size_t(warm.type[i]) - 1];
  view.temperature = warm.temperature;
  view.heat_capacity = heat_capacity_;
  if (!held_)
    return;
  is_held_.resize(n);
  std::transform(this->atom->mask, this->atom->mask + n, is_held_.begin(),
                 [&](int groups) { return std::uint8_t((groups & held_) != 0); });
  view.fixed_temperature = is_held_;
}

template <class HostFix, class Couple>
void HeatFix<HostFix, Couple>::refuse_long_step(double number) const {
  if (number > 1)
    end_run(*this->error,
            fmt::format("fix {} {}: the {} of {} s is {:.3g} times the time in which "
                        "contacts, gaps and radiation would take a particle to the temperature "
                        "around it: use a smaller one",
                        this->id, this->style,
                        options().every == 1 ? "time step" : "step of heat_every",
                        step_of_temperature(), number),
            false);
}

/// Once a step, by all ranks.
template <class HostFix, class Couple> void HeatFix<HostFix, Couple>::look_at_temperatures() {
  const auto now = long(this->update->ntimestep);
  const WarmParticles warm = particles();
  if (looked_at_ == now || warm.capacity.empty())
    return;
  looked_at_ = now;
  report_.look(warm, conduction(), powers_, books_, heat_at_start_, this->world);
  say(*this->lmp, report_.warnings(options().near.surroundings.has_value()));
}

template <class HostFix, class Couple> void HeatFix<HostFix, Couple>::post_run() {
  if (this->update->ntimestep == this->update->firststep)
    return;
  look_again();
  look_at_temperatures();
  if (options().contacts.radius)
    say(*this->lmp, report_.biot_numbers());
  guarded([&] { warn_of_neglected(); });
}

} // namespace granflux::driver
