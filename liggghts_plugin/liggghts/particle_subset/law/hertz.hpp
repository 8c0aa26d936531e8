// SPDX-FileCopyrightText: 2026 The GranFlux developers
// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

#include <algorithm>
#include <cmath>
#include <string_view>

#include "../contact.hpp"
#include "normal_force_limit.hpp"

namespace granflux::particle_subset {

/// Hertz's spring (4/3) Y sqrt(R delta) with Mindlin's tangential stiffness 8 G sqrt(R delta), and
/// dashpots that give the coefficient of restitution: Tsuji, Tanaka, Ishida, Powder Technology 71
/// (1992) 239-250.
struct Hertz {
  static constexpr std::string_view name = "hertz";

  struct Constants {
    double kn, kt;               // over sqrt(R delta)
    double damping_n, damping_t; // over (R delta)^(1/4) sqrt(m)
    double least_force;
  };

  static Constants constants(const Material& m, int a, int b) {
    const double yeff = m.pair("Yeff", a, b);
    const double geff = m.pair("Geff", a, b);
    const double damping = -2 * std::sqrt(5. / 6.) * m.pair("betaeff", a, b);
    return {.kn = 4. / 3. * yeff,
            .kt = 8 * geff,
            .damping_n = damping * std::sqrt(2 * yeff),
            .damping_t = m.option("tangential_damping") ? damping * std::sqrt(8 * geff) : 0.0,
            .least_force = least_normal_force(m)};
  }

  static NormalForce force(const Constants& k, const Contact& c) {
    const double contact_radius = std::sqrt(c.reduced_radius * c.overlap);
    const double root = std::sqrt(contact_radius * c.reduced_mass);
    const double kn = k.kn * contact_radius;
    const double force = kn * c.overlap - k.damping_n * root * c.normal_speed;
    return {.force = std::max(force, k.least_force),
            .stiffness = kn,
            .tangential_stiffness = k.kt * contact_radius,
            .tangential_damping = k.damping_t * root};
  }
};

} // namespace granflux::particle_subset
