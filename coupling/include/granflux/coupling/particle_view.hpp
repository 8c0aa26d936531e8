// SPDX-FileCopyrightText: 2026 The GranFlux developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <numbers>
#include <span>

#include <granflux/cfd/vec3.hpp>
#include <granflux/coupling/heat_state.hpp>

namespace granflux::coupling {

/// What the gas knows of one particle between two coupling steps. Plain doubles, so that a host
/// keeps it as a per-particle array that moves with the particle; all zero for a new particle.
struct FluidState {
  double drag_coefficient = 0; ///< b [kg/s]: drag on the particle is b (gas_velocity - velocity)
  double void_fraction = 0;    ///< at the particle [-]; 0: not yet coupled
  Vec3 gas_velocity;           ///< at the particle [m/s]
  Vec3 pressure_force;         ///< -V grad p of the dynamic pressure, 0 in model B [N]
  Vec3 force;                  ///< fluid force applied last: drag, pressure and buoyancy [N]
  /// Impulse that it received since the last coupling step, less what was taken from the gas for it
  /// then. Buoyancy is left out: the hydrostatic pressure balances the gas's own weight and is not
  /// exchanged [N s].
  Vec3 hand_over;
};
inline constexpr int fluid_state_doubles = 14;
static_assert(sizeof(FluidState) == fluid_state_doubles * sizeof(double));

/// m3, of a radius in m.
[[nodiscard]] inline double sphere_volume(double radius) {
  return 4 * std::numbers::pi / 3 * radius * radius * radius;
}

/// The host's own particles of this rank (no ghosts), borrowed: valid until the host moves again.
/// All spans have one entry a particle, or are empty where noted. SI units.
struct ParticleView {
  std::span<const Vec3> position;   ///< m
  std::span<Vec3> velocity;         ///< m/s
  std::span<Vec3> force;            ///< on the particle [N]; accumulated into
  std::span<const double> radius;   ///< m
  std::span<const double> mass;     ///< kg
  std::span<const std::int64_t> id; ///< unique over all ranks; may be empty, only named in errors
  std::span<FluidState> fluid;
  /// 1: coupled. 0: left alone (outside the fix group): no volume, no force. Empty: all coupled.
  std::span<const std::uint8_t> coupled;
  /// 1: held in place whatever the force (frozen). Empty: all free.
  std::span<const std::uint8_t> fixed;

  // Where particles have temperatures; else all empty.
  std::span<const double> temperature;   ///< K
  std::span<const double> heat_capacity; ///< of the whole particle [J/K]
  std::span<HeatState> heat;
  /// 1: its temperature stays, whatever the heat. Empty: all free.
  std::span<const std::uint8_t> fixed_temperature;

  [[nodiscard]] std::size_t size() const { return position.size(); }
};

} // namespace granflux::coupling
