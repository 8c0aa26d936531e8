// SPDX-FileCopyrightText: 2026 The GranFlux developers
// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

#include <memory>
#include <optional>

#include "fmt_of_lammps.hpp"

#include <lammps/fix.h>

#include "driver/gas_driver.hpp"
#include "driver/particle_rows.hpp"
#include "host_view.hpp"

namespace granflux::lammps {

/// fix ID group granflux/couple case FILE couple_every N ...: two-way coupling of the group's
/// particles with the gas of a case file (docs/reference/granflux_lammps.md).
class FixCouple : public LAMMPS_NS::Fix {
public:
  FixCouple(LAMMPS_NS::LAMMPS* lammps, int narg, char** arg);
  ~FixCouple() override;
  FixCouple(const FixCouple&) = delete;
  FixCouple& operator=(const FixCouple&) = delete;

  [[nodiscard]] const driver::GasDriver& gas() const { return *gas_; }

  int setmask() override;
  void init() override;
  void setup(int) override;
  void post_force(int) override;
  void post_run() override;
  double compute_vector(int n) override;
  int modify_param(int narg, char** arg) override;
  void write_restart(FILE* file) override;
  void restart(char* block) override;

  // What the gas knows of the particles.
  void grow_arrays(int n) override;
  void copy_arrays(int from, int to, int) override;
  void set_arrays(int particle) override;
  int pack_exchange(int particle, double* buffer) override;
  int unpack_exchange(int particle, double* buffer) override;
  int pack_restart(int particle, double* buffer) override;
  void unpack_restart(int particle, int nth) override;
  int size_restart(int) override;
  int maxsize_restart() override;
  double memory_usage() override;

  /// The gas's side of the scene.
  void describe(coupling::SceneState& scene) const { gas_->describe(scene); }

private:
  void find_heat();
  void warn_of_later_forces();
  [[nodiscard]] driver::RunSteps run_steps() const;

  std::unique_ptr<driver::GasDriver> gas_;
  ParticleRows fluid_;
  std::optional<ParticleRows> heat_states_; ///< where the gas has a temperature
  std::unique_ptr<HostView> host_;
  bool warned_of_later_forces_ = false;
};

} // namespace granflux::lammps
