// SPDX-FileCopyrightText: 2026 The GranFlux developers
// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

#include <span>
#include <string>

namespace granflux::driver {

inline constexpr char checkpoint_style[] = "granflux/checkpoint";

/// What a script says of checkpoints.
struct CheckpointOptions {
  std::string file;
  long every = 0; ///< steps; 0: only when a signal asks for one
};

/// From what follows the name of the style: FILE every N. Throws ConfigError where that is not
/// allowed.
CheckpointOptions read_checkpoint_options(std::span<char*> words);

} // namespace granflux::driver
