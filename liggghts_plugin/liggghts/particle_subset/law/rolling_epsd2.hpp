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
  static constexpr bool rubs = false; ///< gives way by a slider
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
    const double compliance = stiffness > 0 ? 1 / stiffness : 0.0;
    // With it the work of the mean torque and what the spring stores are accounted for exactly.
    const double stiffness_before = c.before.tangential_stiffness * radius * radius;
    const bool held_before = stiffness_before > 0;
    const double stored_before = held_before ? 0.5 * dot(before, before) / stiffness_before : 0.0;
    const Vec3 mean = 0.5 * ((held_before ? 1.0 : 0.0) * before + old);
    const double released = (stored_before - 0.5 * compliance * dot(old, old)) / dt;
    const double sliding = compliance * lost / dt;
    return {.on_j = old,
            .sliding = sliding,
            .spring = mean,
            .turning = dot(mean, c.relative_spin) + released - sliding};
  }

  /// What the spring holds, whose torque the history is [J].
  static double stored(double stiffness, double radius, const Vec3& torque) {
    return stiffness > 0 ? 0.5 * dot(torque, torque) / (stiffness * radius * radius) : 0.0;
  }
  /// Work that its last torque does until it is gone, half a step long [J]. `spin`: relative.
  static double last_work(const Vec3& torque, const Vec3& spin, double dt) {
    return -0.5 * dt * dot(torque, spin);
  }
};

} // namespace granflux::particle_subset
