// SPDX-FileCopyrightText: 2026 The GranFlux developers
// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

#include <string>
#include <vector>

#include "fmt_of_lammps.hpp"

#include <lammps/atom.h>
#include <lammps/comm.h>
#include <lammps/error.h>
#include <lammps/fix.h>
#include <lammps/lammps.h>
#include <lammps/modify.h>
#include <lammps/update.h>

#include "driver/checkpoint_fix.hpp"
#include "fix_couple.hpp"

namespace granflux::lammps {

class FixCheckpoint : public driver::CheckpointFix<LAMMPS_NS::Fix, FixCouple> {
public:
  FixCheckpoint(LAMMPS_NS::LAMMPS* lammps, int narg, char** arg);

  int setmask() override;
  void setup_pre_force(int) override;

private:
  [[nodiscard]] int stages_of_forces() const override;
  void write_host_file(const std::string& path) override;
  void stop_host() override;
  void restore_histories() override;
  void restore_pair_history();

  std::vector<std::vector<double>> histories_; ///< of walls, by fix, until the set-up is over
};

} // namespace granflux::lammps
