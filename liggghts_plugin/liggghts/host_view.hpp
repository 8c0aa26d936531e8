// SPDX-FileCopyrightText: 2026 The GranFlux developers
// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include <liggghts/pointers.h>

#include "driver/host.hpp"
#include "driver/particle_groups.hpp"

namespace LAMMPS_NS {
class FixPropertyAtom;
}

namespace granflux::liggghts {

class FixCheckpoint;
class FixHeat;

/// LIGGGHTS as the gas sees it. Positions, velocities and forces are LIGGGHTS' own arrays; the
/// fluid states live in a fix property/atom, so that they move, are deleted and are written to
/// restart files with their particles.
class HostView : public driver::Host, private LAMMPS_NS::Pointers {
public:
  /// group_bit: the particles that are coupled. held_bit: further particles held in place, or 0.
  HostView(LAMMPS_NS::LAMMPS* lammps, int group_bit, int held_bit);

  /// Where the gas is solved.
  void set_fluid(LAMMPS_NS::FixPropertyAtom& fluid) { fluid_ = &fluid; }

  /// The fixes may have changed between runs: call before each.
  void find_held();

  /// Where particles have temperatures, and what they exchange with the gas.
  void set_heat(FixHeat* heat, LAMMPS_NS::FixPropertyAtom* states) {
    heat_ = heat;
    heat_states_ = states;
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
  [[nodiscard]] coupling::HeatState* heat_states() const;

  LAMMPS_NS::FixPropertyAtom* fluid_ = nullptr;
  FixHeat* heat_ = nullptr;
  LAMMPS_NS::FixPropertyAtom* heat_states_ = nullptr;
  driver::ParticleGroups groups_;
  std::vector<std::int64_t> id_;
};

} // namespace granflux::liggghts
