// SPDX-FileCopyrightText: 2026 The GranFlux developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <cmath>
#include <numbers>

#include <granflux/coupling/contact_heat/contact_radius.hpp>
#include <granflux/coupling/drag/wen_yu.hpp>
#include <granflux/coupling/effects/scene_state.hpp>
#include <granflux/coupling/near_heat/gas_gap.hpp>
#include <granflux/coupling/near_heat/radiation.hpp>
#include <granflux/coupling/nusselt/gunn.hpp>

// What one particle of a scene exchanges with what is around it (docs/effects.md, section 2).
namespace granflux::coupling {

/// Particles rest on each other from this solid fraction on; below they collide.
inline constexpr double packed_from = 0.4;
/// Contacts of a particle in a packing.
inline constexpr double packed_contacts = 6;

[[nodiscard]] inline double mass_of_one(const SceneState& s) {
  const double d = s.particles.diameter;
  return s.particles.density * std::numbers::pi / 6 * d * d * d;
}

[[nodiscard]] inline double void_fraction_of(const SceneState& s) {
  return 1 - s.particles.solid_fraction;
}

/// Of gas relative to a particle [m/s]: as solved, or what inlets bring in and particles move.
/// Walls carry a packing along with its gas; elsewhere they stir the gas beside the particles.
[[nodiscard]] inline double slip_of(const SceneState& s) {
  if (!s.gas)
    return 0;
  if (s.gas->slip > 0)
    return s.gas->slip;
  const double walls = s.particles.solid_fraction < packed_from ? s.gas->wall_speed : 0;
  return s.gas->speed / void_fraction_of(s) + std::max(s.particles.speed, walls);
}

/// As the gas meets particles: of those that a parcel stands for [m].
[[nodiscard]] inline double diameter_in_gas(const SceneState& s) {
  return s.particles.diameter / (s.gas ? s.gas->coarse_graining : 1);
}
[[nodiscard]] inline double particles_a_parcel(const SceneState& s) {
  return s.gas ? std::pow(s.gas->coarse_graining, 3) : 1;
}

[[nodiscard]] inline double reynolds_of(const SceneState& s) {
  return s.gas ? s.gas->density * void_fraction_of(s) * slip_of(s) * diameter_in_gas(s) /
                     s.gas->viscosity
               : 0;
}

/// Drag coefficient of one particle or parcel, by Wen and Yu [kg/s].
[[nodiscard]] inline double drag_coefficient_of(const SceneState& s) {
  if (!s.gas)
    return 0;
  const double eps = void_fraction_of(s);
  return particles_a_parcel(s) * 3 * std::numbers::pi * s.gas->viscosity * diameter_in_gas(s) *
         eps * WenYu{}({.reynolds = reynolds_of(s), .void_fraction = eps});
}

/// Collisions of a particle in a second, by kinetic theory without crowding.
[[nodiscard]] inline double collisions_of(const SceneState& s) {
  return 6 * s.particles.solid_fraction * s.particles.speed / s.particles.diameter;
}

/// Between equal particles of the scene [1/Pa].
[[nodiscard]] inline double inverse_modulus_of(const SceneState& s) {
  return s.heat && s.heat->young > 0
             ? inverse_modulus(s.heat->young, s.heat->poisson, s.heat->young, s.heat->poisson)
             : 0;
}

/// Mean force that presses a particle's contact [N]: in a packing the weight of what lies above at
/// half its height, or at least its own, and collisions.
[[nodiscard]] inline double contact_force_of(const SceneState& s) {
  const double m = mass_of_one(s), g = s.gravity;
  const double layers = std::max(1.0, s.particles.height / (2 * s.particles.diameter));
  return m * (g * layers + collisions_of(s) * s.particles.speed);
}

/// Radius of a contact where the true modulus is not known, over that of the particle: an upper
/// bound.
inline constexpr double unknown_contact = 0.1;

/// Conductance of all contacts of a particle [W/K]. In a packing those at rest; else of collisions,
/// each of the duration and the mean force of Hertz's law: t = 2.87 (m*^2/(R* E^2 v))^(1/5), Landau
/// and Lifshitz, Theory of Elasticity, section 9.
[[nodiscard]] inline double contact_conductance_of(const SceneState& s) {
  if (!s.heat || !(s.heat->conductivity > 0) || s.particles.count < 2)
    return 0;
  const double inverse = inverse_modulus_of(s), d = s.particles.diameter, v = s.particles.speed;
  const double per_radius = 2 * s.heat->conductivity;
  if (!(inverse > 0))
    return packed_contacts * per_radius * unknown_contact * d / 2;
  if (s.particles.solid_fraction >= packed_from)
    return packed_contacts * per_radius * std::cbrt(contact_force_of(s) * d / 4 * inverse);
  if (!(v > 0))
    return 0;
  const double m = mass_of_one(s) / 2, modulus = 0.75 / inverse;
  const double duration = 2.87 * std::pow(m * m / (d / 4 * modulus * modulus * v), 0.2);
  const double force = 2 * m * v / duration;
  const double contacts = std::min(packed_contacts, collisions_of(s) * duration);
  return contacts * per_radius * std::cbrt(force * d / 4 * inverse);
}

/// Conductivity of the gas around the particles; 0: unknown [W/(m K)].
[[nodiscard]] inline double gas_conductivity_of(const SceneState& s) {
  if (s.heat && s.heat->gap_conductivity > 0)
    return s.heat->gap_conductivity;
  return s.gas ? s.gas->conductivity : 0;
}

/// Conductance of the gas in the gaps around a particle [W/K]: neighbours touch in a packing, and
/// lie at random elsewhere.
[[nodiscard]] inline double gap_conductance_of(const SceneState& s) {
  const double k = gas_conductivity_of(s);
  if (!s.heat || !(k > 0) || s.particles.count < 2)
    return 0;
  const GasGap gap{.conductivity = k, .layer = s.heat->gap_layer, .least_gap = s.heat->least_gap};
  const double radius = s.particles.diameter / 2, reach = 1 + s.heat->gap_layer / 2;
  const bool packed = s.particles.solid_fraction >= packed_from;
  const double neighbours =
      packed
          ? packed_contacts
          : std::min(packed_contacts, 8 * s.particles.solid_fraction * (reach * reach * reach - 1));
  return neighbours * gap.conductance(radius, radius, s.particles.diameter);
}

/// Conductance between a particle and the gas, by Gunn; 0 where the gas has no temperature [W/K].
[[nodiscard]] inline double convection_conductance_of(const SceneState& s) {
  if (!s.gas || !(s.gas->conductivity > 0))
    return 0;
  const double prandtl = s.gas->viscosity * s.gas->heat_capacity / s.gas->conductivity;
  return particles_a_parcel(s) * std::numbers::pi * diameter_in_gas(s) * s.gas->conductivity *
         Gunn{}({.reynolds = reynolds_of(s),
                 .prandtl = prandtl,
                 .void_fraction = void_fraction_of(s)});
}

/// What a particle radiates for each kelvin [W/K], at the hottest of the scene.
[[nodiscard]] inline double radiation_conductance_of(const SceneState& s) {
  if (!s.heat)
    return 0;
  const double t = std::max(s.hottest, 0.0), d = s.particles.diameter;
  return 4 * s.heat->emissivity * stefan_boltzmann * t * t * t * std::numbers::pi * d * d;
}

/// Of all ways for heat to and from a particle [W/K].
[[nodiscard]] inline double conductance_of(const SceneState& s) {
  return contact_conductance_of(s) + gap_conductance_of(s) + convection_conductance_of(s) +
         radiation_conductance_of(s);
}

/// Power of sliding [W]: as measured, or at most mu F v, F the particle's weight and what
/// collisions press with.
[[nodiscard]] inline double friction_power_of(const SceneState& s) {
  if (!s.heat)
    return 0;
  if (s.heat->friction_power > 0)
    return s.heat->friction_power;
  const double v = s.particles.speed;
  return s.heat->friction_coefficient * mass_of_one(s) * (s.gravity + collisions_of(s) * v) * v;
}

/// Power of dashpots [W]: at most what motion has, lost in every collision.
[[nodiscard]] inline double damping_power_of(const SceneState& s) {
  const double v = s.particles.speed;
  return 0.5 * mass_of_one(s) * v * v * collisions_of(s);
}

} // namespace granflux::coupling
