// SPDX-FileCopyrightText: 2026 The GranFlux developers
// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "fmt_of_lammps.hpp"

#include <lammps/pointers.h>

#include "driver/host.hpp"
#include "driver/particle_groups.hpp"
#include "driver/particle_rows.hpp"

namespace granflux::lammps {

using driver::ParticleRows;

class FixCheckpoint;
class FixHeat;

/// LAMMPS as the gas sees it. Positions, velocities and forces are LAMMPS' own arrays; the fluid
/// states are rows of the fix that has this view.
class HostView : public driver::Host, private LAMMPS_NS::Pointers {
public:
  /// group_bit: the particles that are coupled. held_bit: further particles held in place, or 0.
  HostView(LAMMPS_NS::LAMMPS* lammps, ParticleRows& fluid, int group_bit, int held_bit);

  /// The fixes may have changed between runs: call before each.
  void find_held();

  /// Where particles have temperatures, and what they exchange with the gas.
  void set_heat(FixHeat& heat, ParticleRows& states) {
    heat_ = &heat;
    heat_states_ = &states;
  }

  driver::Scene scene() override;
  driver::ContactTimes contact_times() override;
  coupling::ParticleView particles(bool with_id) override;
  void clear_frozen_forces() override;
  double step_temperatures() override;
  bool forces_come_back() override;
  std::optional<driver::GoodCheckpoint> last_checkpoint() override;
  void describe(coupling::SceneState& scene) override;
  void say(const std::string& text) override;

private:
  [[nodiscard]] const FixCheckpoint* checkpoint() const;
  [[nodiscard]] std::span<coupling::HeatState> heat_states();

  ParticleRows& fluid_;
  FixHeat* heat_ = nullptr;
  ParticleRows* heat_states_ = nullptr;
  driver::ParticleGroups groups_;
  std::vector<std::int64_t> id_;
};

} // namespace granflux::lammps
