// SPDX-FileCopyrightText: 2026 The GranFlux developers
// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "fmt_of_lammps.hpp"

#include <lammps/fix.h>

#include "driver/checkpointer.hpp"
#include "driver/kept_forces.hpp"

namespace granflux::lammps {

/// fix ID all granflux/checkpoint FILE every N: restart files from which a run goes on to the last
/// bit (docs/reference/fix_granflux_checkpoint.md).
class FixCheckpoint : public LAMMPS_NS::Fix {
public:
  FixCheckpoint(LAMMPS_NS::LAMMPS* lammps, int narg, char** arg);
  ~FixCheckpoint() override;

  /// The forces of the last step are known, so that the run that is set up needs no others.
  [[nodiscard]] bool brings_forces() const { return kept_.are_of(this_step()); }
  [[nodiscard]] const driver::Checkpointer& point() const { return *point_; }

  int setmask() override;
  void init() override;
  void setup_pre_force(int) override;
  void setup(int) override;
  void pre_exchange() override;
  void end_of_step() override;

  void write_restart(FILE* file) override;
  void restart(char* block) override;

  void grow_arrays(int n) override;
  void copy_arrays(int from, int to, int) override;
  void set_arrays(int particle) override;
  int pack_exchange(int particle, double* buffer) override;
  int unpack_exchange(int particle, double* buffer) override;
  int pack_restart(int particle, double* buffer) override;
  void unpack_restart(int particle, int nth) override;
  int size_restart(int particle) override;
  int maxsize_restart() override;

private:
  [[nodiscard]] driver::KeptForces::Step this_step() const;
  void restore_pair_history();
  void say(const std::string& text) const;

  std::unique_ptr<driver::Checkpointer> point_;
  driver::KeptForces kept_;
  std::vector<std::vector<double>> histories_; ///< of walls, by fix, until the set-up is over
  bool writing_ = false;                       ///< what is packed goes to a checkpoint
};

} // namespace granflux::lammps
