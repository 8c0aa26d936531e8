// SPDX-FileCopyrightText: 2026 The GranFlux developers
// SPDX-License-Identifier: GPL-2.0-or-later

#include "heat_every.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include <fmt/core.h>

#include <granflux/cfd/error.hpp>

namespace granflux::driver {

namespace {

/// Of all contacts [s]; infinity where none is known.
double shortest(const ContactTimes& times, double speed) {
  double least = std::numeric_limits<double>::infinity();
  if (times.linear.seconds > 0)
    least = times.linear.seconds;
  if (times.hertzian.seconds > 0)
    least = std::min(least, ContactTimes::at_speed(times.hertzian, speed));
  return least;
}

} // namespace

std::string check_heat_every(int every, double dt, const ContactTimes& times, double speed) {
  const double contact = shortest(times, speed);
  if (every == 1 || speed == 0 || every * dt <= 0.5 * contact)
    return {}; // what is at rest does not collide
  const auto text = [&](const char* what, double part) {
    return fmt::format("heat_every {}: {} time steps are {:.2g} s, and the shortest contact lasts "
                       "{:.2g} s: {}; at most {} time steps for that",
                       every, every, every * dt, contact, what,
                       std::max(1., std::floor(part * contact / dt)));
  };
  if (every * dt > contact)
    throw ConfigError(text("must be no longer, or a collision conducts nothing", 1));
  return "WARNING: granflux: " +
         text("the heat of a single collision scatters by more than 10 % unless it is seen twice",
              0.5) +
         "\n";
}

void check_heat_every_with_gas(int every, int couple_every) {
  if (every > 1 && couple_every == 0)
    throw ConfigError(
        fmt::format("heat_every {}: must be 1 where the gas follows a Courant number", every));
  if (couple_every % every != 0)
    throw ConfigError(fmt::format("heat_every {}: couple_every {} of fix granflux/couple must be a "
                                  "multiple of it",
                                  every, couple_every));
}

} // namespace granflux::driver
