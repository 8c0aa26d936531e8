// SPDX-FileCopyrightText: 2026 The GranFlux developers
// SPDX-License-Identifier: GPL-2.0-or-later

#include "particle_bounds.hpp"

#include <cmath>

#include <fmt/core.h>

namespace granflux::driver {

namespace {

// docs/reference/stable_range.md tells where these come from.
constexpr double contact_limit = 0.1, contact_advised = 0.05;
constexpr double rayleigh_limit = 0.2, rayleigh_advised = 0.1;
constexpr double path_limit = 1, path_advised = 0.1;

} // namespace

ParticleBounds::ParticleBounds(cfd::StableRange& range) : range_(range) {
  const auto up_to = [this](double limit) {
    return [this, limit](double number) {
      return number > 0 ? fmt::format("timestep up to {:.3g}", time_step_ * limit / number)
                        : std::string("timestep");
    };
  };
  contact_ = range.add({.name = "DEM step / contact time",
                        .limit = contact_limit,
                        .advised = contact_advised,
                        .cure = up_to(contact_limit)});
  rayleigh_ = range.add({.name = "DEM step / Rayleigh time",
                         .limit = rayleigh_limit,
                         .advised = rayleigh_advised,
                         .cure = up_to(rayleigh_limit)});
  path_ = range.add({.name = "path in a DEM step / radius",
                     .limit = path_limit,
                     .advised = path_advised,
                     .cure = up_to(path_limit)});
}

void ParticleBounds::set(const ContactTimes& times, double time_step, double speed,
                         double speed_over_radius) {
  time_step_ = time_step;
  if (times.least_radius == 0) {
    for (const std::size_t row : {contact_, rayleigh_, path_})
      range_.forget(row, "no particles yet");
    return;
  }
  range_.set(path_, speed_over_radius * time_step);
  if (!times.unknown.empty()) {
    for (const std::size_t row : {contact_, rayleigh_})
      range_.forget(row, times.unknown);
    return;
  }
  ContactTimes::Least shortest = times.linear;
  if (times.hertzian.seconds > 0)
    shortest = times.hertzian, shortest.seconds = ContactTimes::at_speed(times.hertzian, speed);
  if (shortest.seconds > 0) {
    range_.rename(contact_, fmt::format("DEM step / contact time of types {}-{}", shortest.first,
                                        shortest.second));
    range_.set(contact_, time_step / shortest.seconds);
  } else {
    range_.forget(contact_, "the contacts have no stiffness");
  }
  if (times.rayleigh.seconds > 0) {
    range_.rename(rayleigh_,
                  fmt::format("DEM step / Rayleigh time of type {}", times.rayleigh.first));
    range_.set(rayleigh_, time_step / times.rayleigh.seconds);
  } else {
    range_.forget(rayleigh_, "the contacts know no Young's modulus");
  }
}

} // namespace granflux::driver
