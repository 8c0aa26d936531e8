// SPDX-FileCopyrightText: 2026 The GranFlux developers
// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

#include <cmath>
#include <string_view>

#include "../contact.hpp"
#include "../material.hpp"

namespace granflux::particle_subset {

/// Elastic-plastic spring of rolling without dashpot (Iwashita and Oda's stiffness kt R^2; Ai,
/// Chen, Rotter, Ooi, Powder Technology 206 (2011) 269-282, model C). The torque is the history.
struct RollingEpsd2 {
  static constexpr std::string_view name = "epsd2";
  static constexpr bool acts = true;
  static constexpr int history = 3;

  struct Constants {
    double rolling_friction;
    double without_torsion; // 1: the spin along the normal is taken out
  };
  static Constants constants(const Material& m, int a, int b) {
    return {m.pair("coeffRollFrict", a, b), double(!m.option("torsionTorque"))};
  }

  static RollingTorque torque(const Constants& k, const Contact& c, const NormalForce& normal,
                              double dt, Vec3& old) {
    const double radius = c.reduced_radius;
    const Vec3 spin =
        c.relative_spin - k.without_torsion * dot(c.relative_spin, c.normal) * c.normal;
    const Vec3 before = old;
    const Vec3 elastic = old + dt * normal.tangential_stiffness * radius * radius * spin;
    const double size = norm(elastic);
    const double limit = std::abs(normal.force) * radius * k.rolling_friction;
    const double held = size > limit ? limit / size : 1.0;
    old = held * elastic;
    // The slider gives way by what the spring is shortened, against the mean torque of the step.
    const double lost = 0.5 * (1 - held) * dot(before + old, elastic);
    const double stiffness = normal.tangential_stiffness * radius * radius;
    return {
        .on_j = old, .sliding = stiffness > 0 ? lost / (stiffness * dt) : 0.0, .against_spin = {}};
  }

  /// What the spring holds, whose torque the history is [J].
  static double stored(double stiffness, double radius, const double* torque) {
    const Vec3 t{torque[0], torque[1], torque[2]};
    return stiffness > 0 ? 0.5 * dot(t, t) / (stiffness * radius * radius) : 0.0;
  }
};

} // namespace granflux::particle_subset
