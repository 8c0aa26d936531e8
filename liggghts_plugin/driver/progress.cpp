// SPDX-FileCopyrightText: 2026 The GranFlux developers
// SPDX-License-Identifier: GPL-2.0-or-later

#include "progress.hpp"

#include <cmath>

#include <fmt/core.h>

namespace granflux::driver {

std::string duration(double seconds) {
  const long s = std::lround(seconds);
  if (s >= 3600)
    return fmt::format("{} h {:02} min", s / 3600, s % 3600 / 60);
  if (s >= 60)
    return fmt::format("{} min {:02} s", s / 60, s % 60);
  return fmt::format("{} s", s);
}

void Progress::start(long first_step, long last_step, double now) {
  first_step_ = first_step;
  last_step_ = last_step;
  start_ = now;
  next_ = now + every_;
}

std::string Progress::line(long step, double simulated, double now) {
  if (every_ == 0 || now < next_ || step <= first_step_)
    return {};
  next_ = now + every_;
  const double done = double(step - first_step_) / double(last_step_ - first_step_);
  const double elapsed = now - start_;
  const double rate = double(step - first_step_) / elapsed;
  return fmt::format("granflux: {:5.1f} % done, gas time {:.6g} s, {:.4g} steps/s, about {} left\n",
                     100 * done, simulated, rate, duration(elapsed * (1 - done) / done));
}

} // namespace granflux::driver
