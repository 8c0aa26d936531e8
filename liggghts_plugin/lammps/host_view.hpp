// SPDX-FileCopyrightText: 2026 The GranFlux developers
// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

#include <optional>
#include <span>

#include "fmt_of_lammps.hpp"

#include <lammps/atom.h>
#include <lammps/comm.h>
#include <lammps/domain.h>
#include <lammps/fix.h>
#include <lammps/lammps.h>
#include <lammps/modify.h>
#include <lammps/pointers.h>
#include <lammps/update.h>

#include "driver/particle_rows.hpp"
#include "driver/script_host.hpp"
#include "fix_heat.hpp"

namespace granflux::lammps {

using driver::ParticleRows;

class FixCheckpoint;

/// LAMMPS as the gas sees it. The fluid states are rows of the fix that has this view.
class HostView : public driver::ScriptHost<LAMMPS_NS::Pointers, FixCheckpoint, FixHeat> {
public:
  HostView(LAMMPS_NS::LAMMPS* lammps, ParticleRows& fluid, int group_bit, int held_bit);

  /// Where particles have temperatures, and what they exchange with the gas.
  void set_heat(FixHeat& heat, ParticleRows& states) {
    ScriptHost::set_heat(heat);
    heat_states_ = &states;
  }

  driver::ContactTimes contact_times() override;

private:
  std::optional<Vec3> gravity() override;
  std::span<coupling::FluidState> fluid_states() override;
  std::span<coupling::HeatState> heat_states() override;

  ParticleRows& fluid_;
  ParticleRows* heat_states_ = nullptr;
};

} // namespace granflux::lammps
