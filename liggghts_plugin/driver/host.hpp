// SPDX-FileCopyrightText: 2026 The GranFlux developers
// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

#include <optional>
#include <string>

#include <granflux/coupling/effects/scene_state.hpp>
#include <granflux/coupling/particle_view.hpp>

#include "checkpointer.hpp"
#include "contact_time.hpp"
#include "scene.hpp"

namespace granflux::driver {

/// The program that moves the particles, as the gas sees it.
class Host {
public:
  virtual ~Host() = default;

  /// Collective.
  virtual Scene scene() = 0;

  /// What of the contacts limits the time step, by the particles as they are. Collective.
  virtual ContactTimes contact_times() = 0;

  /// The particles of this rank: valid until the host moves, sorts or communicates them. `with_id`
  /// where errors may have to name a particle.
  virtual coupling::ParticleView particles(bool with_id) = 0;

  /// As the host's own freezing does, which ran before the fluid force was added.
  virtual void clear_frozen_forces() = 0;

  /// Where the gas has a temperature: the step of those of the particles. Returns the heat that
  /// this rank's particles took from the gas [J].
  virtual double step_temperatures() = 0;

  /// A checkpoint brings the forces of the last step, fluid forces among them, and puts them in
  /// place behind the set-up.
  virtual bool forces_come_back() = 0;
  /// Nothing where the run has written none.
  virtual std::optional<GoodCheckpoint> last_checkpoint() = 0;

  /// The scene without its gas: particles, gravity, box, what particles conduct. Collective.
  virtual void describe(coupling::SceneState& scene) = 0;

  /// To screen and log, once for all ranks.
  virtual void say(const std::string& text) = 0;
};

} // namespace granflux::driver
