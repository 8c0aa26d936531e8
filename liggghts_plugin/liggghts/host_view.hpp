// SPDX-FileCopyrightText: 2026 The GranFlux developers
// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

#include <optional>
#include <span>

#include <liggghts/lammps.h>

#include <liggghts/atom.h>
#include <liggghts/comm.h>
#include <liggghts/domain.h>
#include <liggghts/fix.h>
#include <liggghts/modify.h>
#include <liggghts/pointers.h>
#include <liggghts/update.h>

#include "driver/script_host.hpp"
#include "fix_heat.hpp"

namespace granflux::liggghts {

class FixCheckpoint;

/// LIGGGHTS as the gas sees it. The fluid states live in a fix property/atom, so that they move,
/// are deleted and are written to restart files with their particles.
class HostView : public driver::ScriptHost<LAMMPS_NS::Pointers, FixCheckpoint, FixHeat> {
public:
  HostView(LAMMPS_NS::LAMMPS* lammps, int group_bit, int held_bit);

  /// Where the gas is solved.
  void set_fluid(LAMMPS_NS::FixPropertyAtom& fluid) { fluid_ = &fluid; }

  /// Where particles have temperatures, and what they exchange with the gas.
  void set_heat(FixHeat& heat, LAMMPS_NS::FixPropertyAtom& states) {
    ScriptHost::set_heat(heat);
    heat_states_ = &states;
  }

  driver::ContactTimes contact_times() override;

private:
  std::optional<Vec3> gravity() override;
  std::span<coupling::FluidState> fluid_states() override;
  std::span<coupling::HeatState> heat_states() override;

  LAMMPS_NS::FixPropertyAtom* fluid_ = nullptr;
  LAMMPS_NS::FixPropertyAtom* heat_states_ = nullptr;
};

} // namespace granflux::liggghts
