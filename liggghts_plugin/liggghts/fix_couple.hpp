// SPDX-FileCopyrightText: 2026 The GranFlux developers
// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

#include <memory>
#include <optional>
#include <string>

#include <liggghts/fix.h>

#include <granflux/cfd/cgns_writer.hpp>
#include <granflux/coupling/coupler.hpp>

#include "couple_clock.hpp"
#include "couple_options.hpp"
#include "couple_restart.hpp"
#include "fix_heat.hpp"
#include "host_view.hpp"
#include "progress.hpp"
#include "run_report.hpp"

namespace LAMMPS_NS {
class FixPropertyAtom;
}

namespace granflux::liggghts {

/// fix ID group granflux/couple case FILE couple_every N ...: two-way coupling of the group's
/// particles with the gas of a case file (docs/reference/fix_granflux_couple.md).
class FixCouple : public LAMMPS_NS::Fix {
public:
  FixCouple(LAMMPS_NS::LAMMPS* lammps, int narg, char** arg);

  int setmask() override;
  void post_create() override;
  void pre_delete(bool unfix) override;
  void init() override;
  void setup(int) override;
  void pre_final_integrate() override;
  void post_run() override;
  double compute_vector(int n) override;
  int modify_param(int narg, char** arg) override;
  void write_restart(FILE* file) override;
  void restart(char* block) override;

private:
  /// Runs what may throw, and stops LIGGGHTS with the text where it does.
  template <class Work> void guard(Work&& work);
  void refuse_second_fix() const;
  void read_case();
  LAMMPS_NS::FixPropertyAtom* property(const char* name, int values, bool restarts, bool& own);
  void begin();
  std::unique_ptr<coupling::Coupler> make_coupler() const;
  std::string summary() const;
  void start_run();
  void start_timers();
  void exchange();
  void warn_if_stiff(double stiffness);
  void apply(double share);
  void write_fields();
  void fill_outputs();
  void find_heat();
  void say(const std::string& text) const;
  double pressure_drop();

  CoupleOptions options_;
  cfd::GasCase gas_case_;
  coupling::CouplingOptions coupling_options_;
  CoupleClock clock_;
  Progress progress_;

  // Fluid state and outputs of each particle; kept by LIGGGHTS.
  LAMMPS_NS::FixPropertyAtom* fluid_ = nullptr;
  LAMMPS_NS::FixPropertyAtom* drag_force_ = nullptr;
  LAMMPS_NS::FixPropertyAtom* void_fraction_ = nullptr;
  LAMMPS_NS::FixPropertyAtom* gas_velocity_ = nullptr;
  LAMMPS_NS::FixPropertyAtom* heat_states_ = nullptr;     // only where the gas has a temperature
  LAMMPS_NS::FixPropertyAtom* gas_temperature_ = nullptr; // likewise
  FixHeat* heat_ = nullptr;                               // likewise
  bool own_drag_force_ = false, own_void_fraction_ = false, own_gas_velocity_ = false,
       own_gas_temperature_ = false;

  std::unique_ptr<HostView> host_;
  std::unique_ptr<coupling::Coupler> coupler_; // from the first run on
  std::unique_ptr<cfd::CgnsWriter> fields_;    // where the case asks for fields
  double next_fields_time_ = 0;
  std::optional<CoupleState> restored_; // from a restart file, until the first run
  /// Time step of the last force, of which the integrator has applied one half [s]; 0: none yet.
  double last_force_dt_ = 0;

  // Of the current run.
  bool running_ = false;
  bool warned_of_stiffness_ = false; ///< in this or an earlier run
  int timing_of_script_ = 0;         ///< what the command modify_timing asked for
  coupling::CouplingTimes times_at_start_;
  double fields_seconds_ = 0;
  double particle_steps_ = 0; // this rank
  LargestResiduals largest_;
};

} // namespace granflux::liggghts
