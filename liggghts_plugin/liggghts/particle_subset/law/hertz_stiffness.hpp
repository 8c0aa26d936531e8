// SPDX-FileCopyrightText: 2026 The GranFlux developers
// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

#include <algorithm>
#include <cmath>
#include <string_view>

#include "../contact.hpp"
#include "normal_force_limit.hpp"

namespace granflux::particle_subset {

/// Stiffness [Pa] and damping [1/(m s)] given, both times sqrt(R delta); damping also times the
/// reduced mass.
struct HertzStiffness {
  static constexpr std::string_view name = "hertz/stiffness";

  struct Constants {
    double kn, kt, damping_n, damping_t;
    double least_force;
  };

  static Constants constants(const Material& m, int a, int b) {
    return {.kn = m.pair("k_n", a, b),
            .kt = m.pair("k_t", a, b),
            .damping_n = m.pair("gamma_n", a, b),
            .damping_t = m.option("tangential_damping") ? m.pair("gamma_t", a, b) : 0.0,
            .least_force = least_normal_force(m)};
  }

  static NormalForce force(const Constants& k, const Contact& c) {
    const double contact_radius = std::sqrt(c.reduced_radius * c.overlap);
    const double kn = k.kn * contact_radius;
    const double mass = contact_radius * c.reduced_mass;
    const double force = kn * c.overlap - mass * k.damping_n * c.normal_speed;
    return {.force = std::max(force, k.least_force),
            .stiffness = kn,
            .tangential_stiffness = k.kt * contact_radius,
            .tangential_damping = mass * k.damping_t};
  }
};

} // namespace granflux::particle_subset
