// SPDX-FileCopyrightText: 2026 The GranFlux developers
// SPDX-License-Identifier: GPL-2.0-or-later
#include "checkpoint_options.hpp"

#include <charconv>

#include <fmt/core.h>

#include <granflux/cfd/error.hpp>

namespace granflux::driver {

CheckpointOptions read_checkpoint_options(std::span<char*> words) {
  if (words.size() != 3 || std::string(words[1]) != "every")
    throw ConfigError("expected is FILE every N, N steps or 0");
  CheckpointOptions options{.file = words[0], .every = 0};
  if (options.file.find_first_of("*%") != std::string::npos)
    throw ConfigError(fmt::format("file {}: one file only, without * and %", options.file));
  const std::string steps = words[2];
  const auto [end, error] =
      std::from_chars(steps.data(), steps.data() + steps.size(), options.every);
  if (error != std::errc() || end != steps.data() + steps.size() || options.every < 0)
    throw ConfigError(
        fmt::format("every {}: must be a whole number of steps, 0 for none but by signal", steps));
  return options;
}

} // namespace granflux::driver
