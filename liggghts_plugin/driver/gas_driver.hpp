// SPDX-FileCopyrightText: 2026 The GranFlux developers
// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

#include <cstdio>
#include <memory>
#include <mpi.h>
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include <granflux/cfd/cgns_writer.hpp>
#include <granflux/coupling/coupler.hpp>

#include "couple_clock.hpp"
#include "couple_options.hpp"
#include "couple_restart.hpp"
#include "effects.hpp"
#include "host.hpp"
#include "progress.hpp"
#include "run_report.hpp"
#include "stable_run.hpp"

namespace granflux::driver {

/// Steps of one run of the host.
struct RunSteps {
  long first = 0, last = 0;
};

/// The gas of a case beside the particles of a host, from run to run: what `fix granflux/couple` is
/// in every host (docs/reference/fix_granflux_couple.md). Calls are collective, and throw
/// ConfigError or NumericalError on all ranks alike.
class GasDriver {
public:
  /// Entries of value().
  static constexpr int values = 36;

  /// `words`: what follows the name of the style. Reads the case file.
  GasDriver(std::span<char*> words, MPI_Comm comm);

  [[nodiscard]] const CoupleOptions& options() const { return options_; }

  /// Before the first run decides on the effects that the words leave to the numbers, and prints
  /// the table where effects are chosen at all. Collective; does nothing later on.
  void choose_effects(Host& host);
  /// Effects are known, or all that the case has.
  [[nodiscard]] bool effects_are_chosen() const { return chosen_; }
  /// False: nothing is to be done for the gas, nor kept.
  [[nodiscard]] bool solves_gas() const { return effects_.has(Effect::gas); }
  /// A restart file has given its state.
  [[nodiscard]] bool continues() const { return restored_.has_value(); }
  /// The gas's side of the scene.
  void describe(coupling::SceneState& scene) const;
  [[nodiscard]] bool with_heat() const { return gas_case_.energy.has_value(); }

  /// Before a run, with all other forces of the present step in the force array: makes the gas
  /// before the first one, and adds the fluid force of half a step. `dt`: of the particles [s].
  void set_up(Host& host, RunSteps steps, double dt);
  /// A run without set-up; set_up() does the same. Sums of the report start from zero.
  void begin_run(RunSteps steps);
  /// A set-up may take long: times of the report are counted from here on.
  void start_timers();
  [[nodiscard]] bool running() const { return running_; }
  /// Particle steps of each coupling step; 0: they follow a Courant number.
  [[nodiscard]] int couple_every() const {
    return gas_case_.numerics.courant > 0 ? 0 : clock_.every();
  }

  /// In every step, when all other forces are known and velocities are those of its middle: adds
  /// the fluid force. Returns whether it was a coupling step.
  bool step(Host& host, long step, double dt);

  /// Seconds of this rank and run that step() took; a host's own count of fixes may hold them.
  [[nodiscard]] double seconds() const;
  /// At the end of a run, with its times in the host: the table of times and residuals.
  [[nodiscard]] std::string end_run(RunTimes times);

  /// Entry n of the output vector, from 0 on.
  [[nodiscard]] double value(int n);

  /// `fix_modify`: whether it knows the word.
  bool modify(std::string_view key, const char* value);

  /// Rank 0 writes a block for the restart file; read_state() takes the same block on every rank,
  /// and the next run continues from there.
  void write_state(std::FILE* file) const;
  void read_state(const char* block);
  /// After set_up(): throws ConfigError where hosts cannot take so long a block.
  void check_state_fits() const;

private:
  void keep_effects(EffectSet on);
  [[nodiscard]] EffectSet effects_of_case() const;
  [[nodiscard]] coupling::SceneState scene_state(Host& host) const;
  void warn_of_neglected(Host& host, long step);
  [[nodiscard]] std::string effects_report(const RunTimes& mean, double particle_steps) const;
  void begin(Host& host, double dt);
  void load_restored(coupling::Coupler& coupler) const;
  [[nodiscard]] std::unique_ptr<coupling::Coupler> make_coupler() const;
  [[nodiscard]] std::string summary() const;
  void look(Host& host, const coupling::ParticleView& particles);
  void exchange(Host& host, long step);
  void follow_courant();
  void warn_of_limits(Host& host);
  template <class Work> void explaining(Host& host, long step, Work&& work);
  void apply(Host& host, double share);
  void write_fields();
  [[nodiscard]] coupling::CouplingTimes coupling_times() const;
  [[nodiscard]] GasShare gas_share() const;
  [[nodiscard]] double pressure_drop();

  MPI_Comm comm_;
  CoupleOptions options_;
  cfd::GasCase gas_case_;
  coupling::CouplingOptions coupling_options_;
  std::optional<StableRun> stable_; // from the constructor on
  CoupleClock clock_;
  Progress progress_;

  EffectSet available_, effects_; // of the case; on
  bool chosen_ = false;
  EffectWatch watch_;
  bool watch_begun_ = false;
  std::unique_ptr<coupling::Coupler> coupler_; // from the first run on
  std::unique_ptr<cfd::CgnsWriter> fields_;    // where the case asks for fields
  double next_fields_time_ = 0;
  std::optional<SavedCouple> restored_; // from a restart file, until the first run
  /// Time step of the last force, of which the integrator has applied one half [s]; 0: none yet.
  double last_force_dt_ = 0;

  // Of the current run.
  bool running_ = false;
  RunSteps steps_;
  coupling::CouplingTimes times_at_start_;
  long numbers_sent_at_start_ = 0;
  double fields_seconds_ = 0;
  double particle_steps_ = 0; // this rank
  LargestResiduals largest_;
};

} // namespace granflux::driver
