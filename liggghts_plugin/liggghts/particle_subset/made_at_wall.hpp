// SPDX-FileCopyrightText: 2026 The GranFlux developers
// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

#include "contact_heat.hpp"
#include "wall_batch.hpp"

// What a batch of touches makes of heat: set(k, force of the law) for each of them, then give(k,
// particle, ...). What one of these does not take a law does not compute.
namespace granflux::particle_subset {

/// No heat.
struct NothingMade {
  void set(int, const auto&) {}
  void give(int, const Particles&, int, double) {}
};

/// The sliders' work in a time step in which it is all the heat that counts.
template <class Law> class SlidersWork {
public:
  explicit SlidersWork(const HeatOfWall& heat) : kept_(heat) {}
  void set(int k, const typename Law::Force& f) { power_[k] = f.heat.sliding + f.heat.rolling; }
  void give(int k, const Particles&, int particle, double) { kept_.add(particle, power_[k]); }

private:
  KeptAtWall kept_;
  alignas(64) WallBatch::Column power_;
};

/// What is conducted and what is made; `sliders_alone`: contacts make no more than the sliders'
/// work.
template <class Law, bool sliders_alone> class MadeAtWall {
public:
  MadeAtWall(const HeatOfWall& heat, int wall_type) : heat_(heat), wall_type_(wall_type) {}

  void set(int k, const typename Law::Force& f) {
    pressing_[k] = f.pressing;
    sliding_[k] = f.heat.sliding;
    rolling_[k] = f.heat.rolling;
    if constexpr (!sliders_alone) {
      slider_force_[k] = f.heat.slider_force;
      slip_squared_[k] = f.heat.slip_squared;
      dashpots_[k] = f.heat.damping;
      turning_[k] = f.heat.turning;
      damping_force_.set(k, f.damping.force);
      damping_torque_.set(k, f.damping.torque);
    }
    if constexpr (rubs) {
      rubbing_force_.set(k, f.rubbing.force);
      rubbing_torque_.set(k, f.rubbing.torque);
    }
  }

  /// `gap`: between the particle and the wall [m].
  void give(int k, const Particles& p, int particle, double gap) {
    Dissipation made{.sliding = sliding_[k], .rolling = rolling_[k]};
    Resistance damping, rubbing;
    if constexpr (!sliders_alone) {
      made.slider_force = slider_force_[k];
      made.slip_squared = slip_squared_[k];
      made.damping = dashpots_[k];
      made.turning = turning_[k];
      damping = {damping_force_.at(k), damping_torque_.at(k)};
    }
    if constexpr (rubs)
      rubbing = {rubbing_force_.at(k), rubbing_torque_.at(k)};
    heat_.add(particle, p.type[particle], wall_type_, p.radius[particle], -gap, pressing_[k], made);
    if (rubs || (!sliders_alone && heat_.contacts.law->options().damping))
      heat_.resist({particle, damping, rubbing});
  }

private:
  static constexpr bool rubs = Law::rubs;
  const HeatOfWall& heat_;
  const int wall_type_;
  alignas(64) WallBatch::Column pressing_, sliding_, rolling_;
  alignas(64) WallBatch::Column slider_force_, slip_squared_, dashpots_, turning_;
  WallBatch::Vectors damping_force_, damping_torque_, rubbing_force_, rubbing_torque_;
};

} // namespace granflux::particle_subset
