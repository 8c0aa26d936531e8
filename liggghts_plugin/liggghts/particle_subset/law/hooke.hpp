// SPDX-FileCopyrightText: 2026 The GranFlux developers
// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string_view>

#include "../contact.hpp"
#include "../fifth_root.hpp"
#include "normal_force_limit.hpp"

namespace granflux::particle_subset {

/// Linear spring as stiff as a Hertzian contact is at the overlap that the characteristic velocity
/// V reaches, k = (16/15) sqrt(R) Y (15 m V^2 / (16 sqrt(R) Y))^(1/5), and a dashpot that gives the
/// coefficient of restitution. Its powers of radius and mass come together as (R^2 m)^(1/5).
struct Hooke {
  static constexpr std::string_view name = "hooke";

  struct Constants {
    double stiffness;       // over (R^2 m)^(1/5)
    double tangential_part; // of the normal stiffness
    double damping;         // over sqrt(m k)
    double tangential_damping_part;
    double least_force;
  };

  static Constants constants(const Material& m, int a, int b) {
    constexpr double pi = std::numbers::pi;
    const double yeff = m.pair("Yeff", a, b);
    const double velocity = m.scalar("charVel");
    const double log_restitution = m.pair("coeffRestLog", a, b);
    return {.stiffness =
                16. / 15. * std::pow(yeff, 0.8) * std::pow(15. / 16. * velocity * velocity, 0.2),
            .tangential_part = m.option("ktToKnUser") ? 0.285714286 : 1.0, // the host's 2/7
            .damping = 2 * std::abs(log_restitution) /
                       std::sqrt(log_restitution * log_restitution + pi * pi),
            .tangential_damping_part = double(m.option("tangential_damping")),
            .least_force = least_normal_force(m)};
  }

  static NormalForce force(const Constants& k, const Contact& c) {
    const double kn =
        k.stiffness * fifth_root(c.reduced_radius * c.reduced_radius * c.reduced_mass);
    const double damping = k.damping * std::sqrt(c.reduced_mass * kn);
    const double force = kn * c.overlap - damping * c.normal_speed;
    return {.force = std::max(force, k.least_force),
            .stiffness = kn,
            .tangential_stiffness = k.tangential_part * kn,
            .tangential_damping = k.tangential_damping_part * damping};
  }
};

} // namespace granflux::particle_subset
