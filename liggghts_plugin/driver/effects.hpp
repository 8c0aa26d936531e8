// SPDX-FileCopyrightText: 2026 The GranFlux developers
// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

#include <array>
#include <initializer_list>
#include <mpi.h>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <granflux/cfd/vec3.hpp>
#include <granflux/coupling/effects/scene_state.hpp>
#include <granflux/coupling/particle_view.hpp>

#include "particle_subset/near_heat.hpp"

namespace granflux::driver {

/// What a script can switch on and off (docs/effects.md). The first ones are of fix
/// granflux/couple, the others of fix granflux/heat.
enum class Effect {
  gas,
  drag,
  pressure_gradient,
  two_way,
  convection,
  buoyancy,
  conduction,
  gas_gap,
  radiation,
  friction,
  damping
};

/// Some of the effects.
class EffectSet {
public:
  constexpr EffectSet() = default;
  constexpr EffectSet(std::initializer_list<Effect> effects) {
    for (const Effect effect : effects)
      add(effect);
  }
  constexpr void add(Effect effect) { bits_ |= 1u << unsigned(effect); }
  constexpr void remove(Effect effect) { bits_ &= ~(1u << unsigned(effect)); }
  [[nodiscard]] constexpr bool has(Effect effect) const {
    return (bits_ >> unsigned(effect) & 1u) != 0;
  }
  [[nodiscard]] constexpr bool any() const { return bits_ != 0; }
  [[nodiscard]] constexpr EffectSet operator&(EffectSet o) const {
    o.bits_ &= bits_;
    return o;
  }
  constexpr bool operator==(const EffectSet&) const = default;

private:
  unsigned bits_ = 0;
};

inline constexpr EffectSet effects_of_gas{
    Effect::gas,     Effect::drag,       Effect::pressure_gradient,
    Effect::two_way, Effect::convection, Effect::buoyancy};
inline constexpr EffectSet effects_of_heat{Effect::conduction, Effect::gas_gap, Effect::radiation,
                                           Effect::friction, Effect::damping};

[[nodiscard]] std::string_view name_of(Effect effect);

/// The keyword `effects` of a fix.
struct EffectsWanted {
  enum class By { nobody, hand, numbers } by = By::nobody;
  EffectSet named; ///< by hand

  [[nodiscard]] bool given() const { return by != By::nobody; }
};

/// Takes `effects auto`, `effects none` or `effects NAME ...` out of the words of a fix whose other
/// keywords are `keywords`. Throws ConfigError where a name is unknown or of another fix than one
/// with the effects `own`.
EffectsWanted take_effects(std::vector<char*>& words, EffectSet own,
                           std::span<const std::string> keywords);

/// By the numbers of the scene, of those that are `available`. Without particles there is nothing
/// to decide by: all.
[[nodiscard]] EffectSet decide(const coupling::SceneState& scene, EffectSet available);

/// The numbers of the scene, then of each effect of `own`: its number, threshold and source,
/// whether it is on, the error made without it and its cost as measured in docs/effects.md; and
/// what is not modelled.
[[nodiscard]] std::string effects_table(const coupling::SceneState& scene, EffectSet own,
                                        EffectSet available, EffectSet on);

/// Tells once of every effect that is off, or not modelled, and crosses its threshold.
class EffectWatch {
public:
  EffectWatch() = default;
  EffectWatch(EffectSet own, EffectSet available, EffectSet on);

  /// Whether it is time to compute the numbers anew: after 1, 4, 16, ... steps, from there on every
  /// 1000, for that takes 60 to 150 instructions a particle.
  [[nodiscard]] bool due(long step);
  [[nodiscard]] bool would_be_due(long step) const;
  /// Those above their thresholds before the run are in the table: no news.
  void begin(const coupling::SceneState& scene);
  [[nodiscard]] std::string warnings(const coupling::SceneState& scene);

private:
  EffectSet own_, available_, on_;
  std::vector<std::string_view> told_;
  long last_look_ = 0, until_next_ = 1; // steps
};

/// The particles of all ranks, as far as they decide. Collective.
struct ParticleSpans {
  std::span<const Vec3> position, velocity;
  std::span<const double> radius, mass;
};
void add_particles(coupling::SceneState& scene, const ParticleSpans& particles, Vec3 gravity,
                   MPI_Comm comm);

/// The mean slip of the gas where it is solved. Collective.
void add_slip(coupling::SceneState& scene, std::span<const Vec3> velocity,
              std::span<const coupling::FluidState> fluid, MPI_Comm comm);

/// What is known of gas in gaps and of radiation.
void add_near_heat(coupling::HeatOfScene& heat, const particle_subset::NearHeatOptions& near,
                   std::span<const double> emissivity);

/// What fix granflux/heat spent in a run, this rank.
struct HeatSeconds {
  double near = 0, step = 0, particle_steps = 0;
};
/// The lines at the end of a run. Collective.
[[nodiscard]] std::string heat_cost(EffectSet on, HeatSeconds seconds, MPI_Comm comm);

/// The spread of temperatures of all ranks. Collective.
void add_temperatures(coupling::SceneState& scene, std::span<const double> temperature,
                      MPI_Comm comm);

} // namespace granflux::driver
