// SPDX-FileCopyrightText: 2026 The GranFlux developers
// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

#include <memory>

#include <liggghts/fix.h>

#include "driver/gas_driver.hpp"
#include "fix_heat.hpp"
#include "host_view.hpp"

namespace LAMMPS_NS {
class FixPropertyAtom;
}

namespace granflux::liggghts {

/// fix ID group granflux/couple case FILE couple_every N ...: two-way coupling of the group's
/// particles with the gas of a case file (docs/reference/fix_granflux_couple.md).
class FixCouple : public LAMMPS_NS::Fix {
public:
  FixCouple(LAMMPS_NS::LAMMPS* lammps, int narg, char** arg);

  [[nodiscard]] const driver::GasDriver& gas() const { return *gas_; }

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

  /// The gas's side of the scene.
  void describe(coupling::SceneState& scene) const { gas_->describe(scene); }

private:
  LAMMPS_NS::FixPropertyAtom* property(const char* name, int values, bool restarts, bool& own);
  void make_properties();
  void find_heat();
  void time_all_fixes();
  [[nodiscard]] driver::RunSteps run_steps() const;
  void find_who_looks();
  void fill_outputs();

  std::unique_ptr<driver::GasDriver> gas_;
  std::unique_ptr<HostView> host_;

  // Fluid state and outputs of each particle; kept by LIGGGHTS.
  LAMMPS_NS::FixPropertyAtom* fluid_ = nullptr;
  LAMMPS_NS::FixPropertyAtom* drag_force_ = nullptr;
  LAMMPS_NS::FixPropertyAtom* void_fraction_ = nullptr;
  LAMMPS_NS::FixPropertyAtom* gas_velocity_ = nullptr;
  LAMMPS_NS::FixPropertyAtom* heat_states_ = nullptr;     // only where the gas has a temperature
  LAMMPS_NS::FixPropertyAtom* gas_temperature_ = nullptr; // likewise
  bool own_drag_force_ = false, own_void_fraction_ = false, own_gas_velocity_ = false,
       own_gas_temperature_ = false;

  bool outputs_are_looked_at_ = true; ///< between two steps of output
  int timing_of_script_ = 0;          ///< what the command modify_timing asked for
};

} // namespace granflux::liggghts
