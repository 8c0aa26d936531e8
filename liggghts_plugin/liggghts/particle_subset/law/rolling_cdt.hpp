// SPDX-FileCopyrightText: 2026 The GranFlux developers
// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

#include <string_view>

#include "../contact.hpp"
#include "../material.hpp"

namespace granflux::particle_subset {

/// Constant directional torque against the relative spin (Ai, Chen, Rotter, Ooi, Powder Technology
/// 206 (2011) 269-282, model A), of the elastic part of the normal force.
struct RollingCdt {
  static constexpr std::string_view name = "cdt";
  static constexpr bool acts = true;
  static constexpr bool rubs = true; ///< resists by speed
  static constexpr int history = 0;

  struct Constants {
    double rolling_friction;
    double without_torsion; // 1: the part along the normal is taken out
  };
  static Constants constants(const Material& m, int a, int b) {
    return {m.pair("coeffRollFrict", a, b), double(!m.option("torsionTorque"))};
  }

  static RollingTorque torque(const Constants& k, const Contact& c, const NormalForce& normal,
                              double, Vec3&) {
    const double spin = norm(c.relative_spin);
    const double size = k.rolling_friction * normal.stiffness * c.overlap * c.reduced_radius;
    const Vec3 whole = (spin > 0 ? size / spin : 0.0) * c.relative_spin;
    const Vec3 torque = whole - k.without_torsion * dot(whole, c.normal) * c.normal;
    return {.on_j = torque, .against_spin = torque};
  }
};

} // namespace granflux::particle_subset
