// SPDX-FileCopyrightText: 2026 The GranFlux developers
// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

#include <span>
#include <string>
#include <vector>

#include "effects.hpp"
#include "particle_subset/contact_heat.hpp"
#include "particle_subset/near_heat.hpp"

namespace granflux::driver {

/// The words after `fix ID group granflux/heat`.
struct HeatOptions {
  double initial_temperature = 0; ///< K
  particle_subset::ContactHeatOptions contacts;
  particle_subset::NearHeatOptions near;
  std::vector<std::string> fixed_groups; ///< whose temperatures stay
  EffectsWanted effects;
  int every = 1;        ///< time steps that a step of temperature spans
  bool sampled = false; ///< what contacts make is found in those time steps only

  /// Those whose form and data the words give.
  [[nodiscard]] EffectSet available() const;
  /// The others are off from here on.
  void keep(EffectSet on);
};

/// Of the fix in every host.
[[nodiscard]] std::span<const std::string> heat_keywords();

/// Throws ConfigError that names the word and what is allowed.
HeatOptions read_heat_options(std::span<char*> given);

} // namespace granflux::driver
