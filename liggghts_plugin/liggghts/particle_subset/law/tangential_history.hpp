// SPDX-FileCopyrightText: 2026 The GranFlux developers
// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

#include <cmath>
#include <string_view>

#include "../contact.hpp"
#include "../material.hpp"

namespace granflux::particle_subset {

/// Spring, dashpot and slider (Cundall and Strack, Geotechnique 29 (1979) 47-65). The spring's
/// elongation is the contact's history: advanced by the slip, turned into the tangential plane, and
/// shortened to what friction can hold. A contact that slides is not damped.
struct TangentialHistory {
  static constexpr std::string_view name = "history";
  static constexpr bool acts = true;
  static constexpr bool rubs = false; ///< friction is by a slider, not by speed
  static constexpr int history = 3;

  struct Constants {
    double friction;
  };
  static Constants constants(const Material& m, int a, int b) {
    return {m.pair("coeffFrict", a, b)};
  }

  /// On i. `elongation` [m] is brought to the end of the step of `dt` seconds.
  static TangentialForce force(const Constants& k, const Contact& c, const NormalForce& normal,
                               double dt, Vec3& elongation) {
    const Vec3 before = elongation;
    Vec3 spring = elongation + dt * c.slip;
    spring -= dot(spring, c.normal) * c.normal;
    const double elastic = normal.tangential_stiffness * norm(spring);
    const double limit = k.friction * std::abs(normal.force);
    const bool slides = elastic > limit;
    const double held = slides ? limit / elastic : 1.0;
    const double damping = slides ? 0.0 : normal.tangential_damping;
    elongation = held * spring;
    TangentialForce on_i{-normal.tangential_stiffness * elongation - damping * c.slip, {}};
    on_i.dashpot = -damping * c.slip;
    // The slider gives way by what the spring is shortened, against the mean force of the step.
    on_i.heat.sliding = 0.5 / dt * normal.tangential_stiffness * (1 - held) *
                        (dot(before, spring) + held * dot(spring, spring));
    // With it the work of the mean force and what the spring stores are accounted for exactly.
    const double stiffness_before = c.before.tangential_stiffness;
    const double along_normal = dot(before, c.normal);
    on_i.heat.turning = 0.5 / dt *
                        ((stiffness_before - normal.tangential_stiffness) * dot(before, spring) +
                         stiffness_before * (along_normal * along_normal +
                                             dt * dot(before, c.before.slip - c.slip)));
    on_i.heat.slider_force = slides ? limit : 0.0;
    on_i.heat.slip_squared = dot(c.slip, c.slip);
    on_i.heat.damping = damping * dot(c.slip, c.slip);
    return on_i;
  }

  /// What the spring holds [J].
  static double stored(double stiffness, double /*radius*/, const Vec3& elongation) {
    return 0.5 * stiffness * dot(elongation, elongation);
  }
  /// Work that its last force does until it is gone, half a step long [J].
  static double last_work(const ContactBefore& before, const Vec3& elongation, double dt) {
    return -0.5 * dt * before.tangential_stiffness * dot(elongation, before.slip);
  }
};

} // namespace granflux::particle_subset
