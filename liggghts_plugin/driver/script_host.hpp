// SPDX-FileCopyrightText: 2026 The GranFlux developers
// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "fixes_of_run.hpp"
#include "host.hpp"
#include "particle_groups.hpp"
#include "rows_of.hpp"
#include "say.hpp"
#include "scene_of_script.hpp"

namespace granflux::driver {

/// What Host is over the classes of a host, which have the same names in all of them: `Pointers`
/// with all its parts, `Checkpoint` and `Heat` our fixes in it. Positions, velocities and forces
/// are the host's own arrays; where the states lie that belong to the gas is virtual.
template <class Pointers, class Checkpoint, class Heat>
class ScriptHost : public Host, protected Pointers {
public:
  /// group_bit: the particles that are coupled. held_bit: further particles held in place, or 0.
  template <class Lammps>
  ScriptHost(Lammps* lammps, int group_bit, int held_bit)
      : Pointers(lammps), groups_(group_bit, held_bit) {}

  /// The fixes may have changed between runs: call before each.
  void find_held() {
    groups_.forget_fixes();
    for (const auto* fix : fixes_of(*this->modify)) {
      if (std::string_view(fix->style) == "freeze")
        groups_.add_frozen(fix->groupbit);
      if (fix->time_integrate)
        groups_.add_moved(fix->groupbit);
    }
  }

  Scene scene() override { return scene_of(*this->lmp, gravity()); }

  void describe(coupling::SceneState& scene) override {
    describe_particles(*this->lmp, gravity(), scene);
    if (auto* heat = find_fix<Heat>(*this->modify))
      heat->describe(scene);
  }

  coupling::ParticleView particles(bool with_id) override {
    const auto& all = *this->atom;
    const auto n = std::size_t(all.nlocal);
    coupling::ParticleView view;
    view.position = rows_of<const Vec3>(all.x, n);
    view.velocity = rows_of<Vec3>(all.v, n);
    view.force = rows_of<Vec3>(all.f, n);
    view.radius = {all.radius, n};
    view.mass = {all.rmass, n};
    view.fluid = fluid_states();
    groups_.show({all.mask, n}, view);
    if (heat_) {
      heat_->show_to_gas(view);
      view.heat = heat_states();
    }
    if (with_id && all.tag_enable) {
      id_.assign(all.tag, all.tag + n);
      view.id = id_;
    }
    return view;
  }

  void clear_frozen_forces() override {
    const auto n = std::size_t(this->atom->nlocal);
    groups_.clear_frozen_forces({this->atom->mask, n}, rows_of<Vec3>(this->atom->f, n));
  }

  double step_temperatures() override { return heat_->step_with_gas(heat_states().data()); }

  bool forces_come_back() override {
    const auto* fix = find_fix<Checkpoint>(*this->modify);
    return fix && fix->brings_forces();
  }

  std::optional<GoodCheckpoint> last_checkpoint() override {
    const auto* fix = find_fix<Checkpoint>(*this->modify);
    return fix ? fix->point().last() : std::nullopt;
  }

  void say(const std::string& text) override { driver::say(*this->lmp, text); }

protected:
  /// Where particles have temperatures.
  void set_heat(Heat& heat) { heat_ = &heat; }

  /// Sum of the script's constant gravities, if it has any [m/s2].
  virtual std::optional<Vec3> gravity() = 0;
  /// Of the owned particles.
  virtual std::span<coupling::FluidState> fluid_states() = 0;
  virtual std::span<coupling::HeatState> heat_states() = 0;

private:
  Heat* heat_ = nullptr;
  ParticleGroups groups_;
  std::vector<std::int64_t> id_;
};

} // namespace granflux::driver
