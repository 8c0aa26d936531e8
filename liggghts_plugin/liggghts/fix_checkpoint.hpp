// SPDX-FileCopyrightText: 2026 The GranFlux developers
// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

#include <string>

#include <liggghts/lammps.h>

#include <liggghts/atom.h>
#include <liggghts/comm.h>
#include <liggghts/error.h>
#include <liggghts/fix.h>
#include <liggghts/modify.h>
#include <liggghts/update.h>

#include "driver/checkpoint_fix.hpp"
#include "fix_couple.hpp"
#include "particle_subset/rare_look.hpp"

namespace granflux::liggghts {

class FixCheckpoint : public driver::CheckpointFix<LAMMPS_NS::Fix, FixCouple>,
                      public particle_subset::RareLook {
public:
  using CheckpointFix::CheckpointFix;

  int setmask() override;
  [[nodiscard]] bool looks_at(long step) const override { return step == point().due(); }

private:
  [[nodiscard]] int stages_of_forces() const override;
  void write_host_file(const std::string& path) override;
  void stop_host() override;
  void hand_histories_to_particles() override;
};

} // namespace granflux::liggghts
