// SPDX-FileCopyrightText: 2026 The GranFlux developers
// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

#include <algorithm>
#include <string_view>

#include "../contact.hpp"
#include "normal_force_limit.hpp"

namespace granflux::particle_subset {

/// Linear spring and dashpot with given stiffness [N/m] and damping, absolute [kg/s] or per
/// reduced mass [1/s].
struct HookeStiffness {
  static constexpr std::string_view name = "hooke/stiffness";

  struct Constants {
    double kn, kt;
    double damping_n, damping_t;                   // absolute
    double damping_n_per_mass, damping_t_per_mass; // one pair of the two is 0
    double least_force;
  };

  static Constants constants(const Material& m, int a, int b) {
    const double tangential = m.option("tangential_damping");
    Constants c{.kn = m.pair("k_n", a, b),
                .kt = m.pair("k_t", a, b),
                .damping_n = 0,
                .damping_t = 0,
                .damping_n_per_mass = 0,
                .damping_t_per_mass = 0,
                .least_force = least_normal_force(m)};
    if (m.option("absolute_damping")) {
      c.damping_n = m.pair("gamman_abs", a, b);
      c.damping_t = tangential * m.pair("gammat_abs", a, b);
    } else {
      c.damping_n_per_mass = m.pair("gamman", a, b);
      c.damping_t_per_mass = tangential * m.pair("gammat", a, b);
    }
    return c;
  }

  static NormalForce force(const Constants& k, const Contact& c) {
    const double damping = k.damping_n + c.reduced_mass * k.damping_n_per_mass;
    const double force = k.kn * c.overlap - damping * c.normal_speed;
    return {.force = std::max(force, k.least_force),
            .stiffness = k.kn,
            .tangential_stiffness = k.kt,
            .tangential_damping = k.damping_t + c.reduced_mass * k.damping_t_per_mass};
  }
};

} // namespace granflux::particle_subset
