// SPDX-FileCopyrightText: 2026 The GranFlux developers
// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

#include <cmath>
#include <string_view>

#include "../contact.hpp"
#include "../material.hpp"

namespace granflux::particle_subset {

/// A dashpot alone, limited by friction.
struct TangentialNoHistory {
  static constexpr std::string_view name = "no_history";
  static constexpr bool acts = true;
  static constexpr bool rubs = true; ///< friction resists by speed
  static constexpr int history = 0;

  struct Constants {
    double friction;
  };
  static Constants constants(const Material& m, int a, int b) {
    return {m.pair("coeffFrict", a, b)};
  }

  static TangentialForce force(const Constants& k, const Contact& c, const NormalForce& normal,
                               double, Vec3&) {
    const double speed = norm(c.slip);
    const double limit = k.friction * std::abs(normal.force);
    const bool slides = limit < normal.tangential_damping * speed;
    const double damping = slides ? limit / speed : normal.tangential_damping;
    TangentialForce on_i{-damping * c.slip, {}};
    const double power = damping * speed * speed;
    on_i.rubbing = (slides ? 1.0 : 0.0) * on_i.force;
    on_i.dashpot = on_i.force - on_i.rubbing;
    on_i.heat.sliding = slides ? power : 0.0;
    on_i.heat.slider_force = slides ? limit : 0.0;
    on_i.heat.slip_squared = speed * speed;
    on_i.heat.damping = slides ? 0.0 : power;
    return on_i;
  }
};

} // namespace granflux::particle_subset
