// SPDX-FileCopyrightText: 2026 The GranFlux developers
// SPDX-License-Identifier: GPL-2.0-or-later

#include "launch_options.hpp"

#include <fmt/core.h>

#include <granflux/cfd/error.hpp>

#include "driver/command_line.hpp"

namespace granflux::liggghts {

namespace {

LaunchOptions options;

} // namespace

const LaunchOptions& launch_options() {
  return options;
}

void take_launch_options(int& argc, char** argv) {
  if (const auto subset = driver::take_option(argc, argv, "-subset")) {
    if (*subset != "on" && *subset != "off")
      throw ConfigError(fmt::format("-subset is '{}': allowed is on or off", *subset));
    options.subset = *subset == "on";
  }
  driver::take_threads(argc, argv);
}

} // namespace granflux::liggghts
