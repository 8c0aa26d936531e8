// SPDX-FileCopyrightText: 2026 The GranFlux developers
// SPDX-License-Identifier: GPL-2.0-or-later

#include "contact_time.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace granflux::driver {

namespace {

constexpr double pi = std::numbers::pi;

void take_shorter(ContactTimes::Least& least, double seconds, int a, int b) {
  if (seconds > 0 && (least.seconds == 0 || seconds < least.seconds))
    least = {seconds, a, b};
}

} // namespace

double longest_step(const NormalSpring& linear, double mass) {
  const double ratio = linear.damping / (2 * std::sqrt(linear.stiffness * mass));
  return 2 * (std::sqrt(1 + ratio * ratio) - ratio) * std::sqrt(mass / linear.stiffness);
}

double contact_time(const NormalSpring& linear, double mass) {
  const double decay = linear.damping / (2 * mass);
  const double squared = linear.stiffness / mass - decay * decay;
  return squared > 0 ? pi / std::sqrt(squared) : std::numeric_limits<double>::infinity();
}

double hertz_contact_time(const NormalSpring& hertzian, double mass, double radius, double speed) {
  // 2 * integral of dx / sqrt(1 - x^2.5) from 0 to 1: 4/5 sqrt(pi) Gamma(2/5) / Gamma(9/10).
  const double shape = 0.8 * std::sqrt(pi) * std::tgamma(0.4) / std::tgamma(0.9);
  const double overlap =
      std::pow(5 * mass * speed * speed / (4 * hertzian.stiffness * std::sqrt(radius)), 0.4);
  return shape * overlap / speed;
}

double rayleigh_time(double radius, double density, double shear, double poisson) {
  return pi * radius * std::sqrt(density / shear) / (0.1631 * poisson + 0.8766);
}

double ContactTimes::at_speed(const Least& hertzian, double speed) {
  return speed > 0 ? hertzian.seconds * std::pow(speed, -0.2)
                   : std::numeric_limits<double>::infinity();
}

ContactTimes shortest_times(
    const std::vector<ParticleType>& types,
    const std::function<NormalSpring(int a, int b, double radius, double mass)>& spring) {
  ContactTimes times;
  for (std::size_t a = 0; a < types.size(); ++a) {
    const ParticleType& one = types[a];
    if (one.least_mass == 0)
      continue;
    const int type = int(a) + 1;
    if (times.least_radius == 0 || one.least_radius < times.least_radius)
      times.least_radius = one.least_radius;
    if (one.young > 0) {
      const double volume = 4 * pi / 3 * std::pow(one.least_radius, 3);
      take_shorter(times.rayleigh,
                   rayleigh_time(one.least_radius, one.least_mass / volume,
                                 0.5 * one.young / (1 + one.poisson), one.poisson),
                   type, type);
    }
    for (std::size_t b = a; b < types.size(); ++b) {
      const ParticleType& other = types[b];
      if (other.least_mass == 0)
        continue;
      const double radius =
          one.least_radius * other.least_radius / (one.least_radius + other.least_radius);
      const double mass = one.least_mass * other.least_mass / (one.least_mass + other.least_mass);
      const NormalSpring of_pair = spring(type, int(b) + 1, radius, mass);
      if (!(of_pair.stiffness > 0))
        continue;
      if (of_pair.hertzian)
        take_shorter(times.hertzian, hertz_contact_time(of_pair, mass, radius, 1), type,
                     int(b) + 1);
      else
        take_shorter(times.linear,
                     std::min(contact_time(of_pair, mass), 0.5 * pi * longest_step(of_pair, mass)),
                     type, int(b) + 1);
    }
  }
  return times;
}

} // namespace granflux::driver
