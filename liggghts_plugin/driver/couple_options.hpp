// SPDX-FileCopyrightText: 2026 The GranFlux developers
// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

#include <span>
#include <string>

#include "effects.hpp"

namespace granflux::driver {

/// What follows the style name in `fix ID group granflux/couple ...`.
struct CoupleOptions {
  std::string case_file;      ///< `case`: path of the TOML file; required
  int couple_every = 0;       ///< `couple_every`: particle steps a coupling step; required
  std::string fixed_group;    ///< `fixed_group`: particles that something else holds in place
  bool any_box = false;       ///< `box any`: the gas grid may differ from the simulation box
  double progress_every = 10; ///< `progress`: seconds of wall time between two lines; 0: none
  EffectsWanted effects;      ///< `effects`
};

/// Throws ConfigError with the keyword, the value found and what is allowed.
CoupleOptions read_couple_options(std::span<char*> given);

/// The value of `couple_every` and of `progress`; also for fix_modify.
int read_couple_every(const std::string& word);
double read_progress_every(const std::string& word);

} // namespace granflux::driver
