// SPDX-FileCopyrightText: 2026 The GranFlux developers
// SPDX-License-Identifier: GPL-2.0-or-later

#include "effects.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include <fmt/core.h>

#include <granflux/cfd/error.hpp>
#include <granflux/coupling/effects/numbers.hpp>

namespace granflux::driver {

using coupling::SceneState;

namespace {

struct NameAndCost {
  std::string_view name;
  /// ns a particle and step on one thread (docs/effects.md, section 4).
  std::string_view cost;
};

constexpr std::array<NameAndCost, 11> table_of_effects{{{"gas", "17"},
                                                        {"drag", "13"},
                                                        {"pressure_gradient", "< 3"},
                                                        {"two_way", "10"},
                                                        {"convection", "18"},
                                                        {"buoyancy", "< 1"},
                                                        {"conduction", "7"},
                                                        {"gas_gap", "27"},
                                                        {"radiation", "117"},
                                                        {"friction", "7"},
                                                        {"damping", "3"}}};

constexpr std::array all_effects{Effect::gas,        Effect::drag,       Effect::pressure_gradient,
                                 Effect::two_way,    Effect::convection, Effect::buoyancy,
                                 Effect::conduction, Effect::gas_gap,    Effect::radiation,
                                 Effect::friction,   Effect::damping};

/// What a number says of an effect.
struct Verdict {
  std::string_view number, formula, source;
  double value, threshold, error;
  [[nodiscard]] bool counts() const { return value > threshold; }
};

template <coupling::DecidingNumber Number> Verdict judge(const SceneState& scene) {
  const double value = Number{}(scene);
  const double error = std::isinf(value) ? 1 : Number::error(value);
  return {Number::name, Number::formula, Number::source, value, Number::threshold, error};
}

Verdict larger(const Verdict& a, const Verdict& b) {
  return b.value / b.threshold > a.value / a.threshold ? b : a;
}

Verdict judge(const SceneState& scene, Effect effect) {
  using namespace coupling;
  switch (effect) {
  case Effect::gas:
    return larger(larger(judge<DragOverWeight>(scene), judge<PressureForce>(scene)),
                  judge<ConvectionShare>(scene));
  case Effect::drag:
    return judge<DragOverWeight>(scene);
  case Effect::pressure_gradient:
    return judge<PressureForce>(scene);
  case Effect::two_way:
    return larger(judge<MomentumCoupling>(scene), judge<HeatCoupling>(scene));
  case Effect::convection:
    return judge<ConvectionShare>(scene);
  case Effect::buoyancy:
    return judge<Richardson>(scene);
  case Effect::conduction:
    return judge<ConductionShare>(scene);
  case Effect::gas_gap:
    return judge<GasGapShare>(scene);
  case Effect::radiation:
    return judge<RadiationShare>(scene);
  case Effect::friction:
    return judge<FrictionOverHeat>(scene);
  case Effect::damping:
    return judge<DampingOverHeat>(scene);
  }
  return {};
}

struct NotModelled {
  std::string_view name;
  Verdict verdict;
};

std::vector<NotModelled> not_modelled(const SceneState& scene, EffectSet own) {
  using namespace coupling;
  if (own == effects_of_heat)
    return {{"temperature inside", judge<Biot>(scene)}};
  return {{"added mass", judge<AddedMass>(scene)},
          {"lift", judge<Lift>(scene)},
          {"viscous heating", judge<ViscousHeating>(scene)}};
}

bool is_effect(std::string_view word) {
  return std::ranges::any_of(all_effects, [&](Effect e) { return name_of(e) == word; });
}

std::string known_names(EffectSet own) {
  std::string text = "auto, none";
  for (const Effect effect : all_effects)
    if (own.has(effect))
      text += fmt::format(", {}", name_of(effect));
  return text;
}

/// One named effect. Throws where it is unknown or of the other fix.
Effect named_effect(const std::string& word, EffectSet own) {
  for (const Effect effect : all_effects)
    if (word == name_of(effect)) {
      if (own.has(effect))
        return effect;
      throw ConfigError(fmt::format("effects {}: is of fix granflux/{}; here there are {}", word,
                                    own == effects_of_heat ? "couple" : "heat", known_names(own)));
    }
  throw ConfigError(fmt::format("effects {}: unknown; there are {}", word, known_names(own)));
}

void check_together(EffectSet named) {
  for (const Effect effect : all_effects)
    if (effects_of_gas.has(effect) && named.has(effect) && !named.has(Effect::gas))
      throw ConfigError(fmt::format("effects {}: needs the effect gas", name_of(effect)));
}

} // namespace

std::string_view name_of(Effect effect) {
  return table_of_effects[std::size_t(effect)].name;
}

EffectsWanted take_effects(std::vector<char*>& words, EffectSet own,
                           std::span<const std::string> keywords) {
  const auto is_keyword = [&](std::size_t i) {
    return std::ranges::find(keywords, words[i]) != keywords.end();
  };
  // Some keywords are named after their effect: one with a value is the keyword.
  const auto begins_next = [&](std::size_t i) {
    return is_keyword(i) && !(is_effect(words[i]) && (i + 1 == words.size() || is_keyword(i + 1) ||
                                                      is_effect(words[i + 1])));
  };
  EffectsWanted wanted;
  std::vector<char*> others;
  for (std::size_t i = 0; i < words.size();) {
    const bool is_value = i > 0 && is_keyword(i - 1) && !others.empty();
    if (std::string_view(words[i]) != "effects" || is_value) {
      others.push_back(words[i++]);
      continue;
    }
    if (wanted.given())
      throw ConfigError("keyword effects is given twice");
    std::vector<std::string> names;
    for (++i; i < words.size() && !begins_next(i) && std::string_view(words[i]) != "effects"; ++i)
      names.emplace_back(words[i]);
    if (names.empty())
      throw ConfigError(
          fmt::format("keyword effects has no value: there are {}", known_names(own)));
    const bool alone = names.front() == "auto" || names.front() == "none";
    if (alone && names.size() > 1)
      throw ConfigError(
          fmt::format("effects {} {}: {} stands alone", names[0], names[1], names[0]));
    wanted.by = names.front() == "auto" ? EffectsWanted::By::numbers : EffectsWanted::By::hand;
    if (!alone)
      for (const std::string& name : names)
        wanted.named.add(named_effect(name, own));
  }
  check_together(wanted.named);
  words = std::move(others);
  return wanted;
}

EffectSet decide(const SceneState& scene, EffectSet available) {
  if (scene.particles.count == 0)
    return available;
  EffectSet on;
  for (const Effect effect : all_effects)
    if (available.has(effect) && judge(scene, effect).counts())
      on.add(effect);
  // Gas is solved for what it does to particles; where they hold it up it must feel their drag.
  if (!(on.has(Effect::drag) || on.has(Effect::pressure_gradient) || on.has(Effect::convection)))
    on = on & effects_of_heat;
  else if (on.has(Effect::two_way) && judge<coupling::MomentumCoupling>(scene).counts())
    on.add(Effect::drag);
  if (on.has(Effect::drag) || on.has(Effect::pressure_gradient) || on.has(Effect::convection))
    on.add(Effect::gas);
  if (!on.has(Effect::convection))
    on.remove(Effect::buoyancy);
  return on;
}

namespace {

std::string percent(double error) {
  return error < 5e-4 ? "< 0.1" : fmt::format("{:.1f}", 100 * error);
}

std::string line(std::string_view name, const Verdict& v, std::string_view state,
                 std::string_view cost) {
  return fmt::format("  {:<20}{:<25}{:>10.3g} {:>6.3g}  {:<13}{:>7}{:>8}  {}; {}\n", name, v.number,
                     v.value, v.threshold, state, percent(v.error), cost, v.formula, v.source);
}

template <class... Numbers> std::string list_numbers(const SceneState& scene) {
  std::string text = "granflux: numbers of the scene:";
  const auto add = [&](auto number) {
    if (const double value = number(scene); value > 0)
      text += fmt::format(" {} {:.3g},", number.name, value);
  };
  (add(Numbers{}), ...);
  return text + fmt::format(" solid fraction {:.2g}\n", scene.particles.solid_fraction);
}

} // namespace

std::string effects_table(const SceneState& scene, EffectSet own, EffectSet available,
                          EffectSet on) {
  using namespace coupling;
  if (scene.particles.count == 0)
    return "granflux: effects: no particles to decide by, all are on\n";
  std::string text =
      own == effects_of_heat
          ? list_numbers<GasOverSolid, RadiationNumber, Biot>(scene)
          : list_numbers<ParticleReynolds, StokesNumber, Froude, Archimedes, MassLoading, Rayleigh>(
                scene);
  text += fmt::format("  {:<20}{:<25}{:>10} {:>6}  {:<13}{:>7}{:>8}  {}\n", "effect", "number",
                      "value", "limit", "state", "error,%", "cost,ns", "formula; source");
  for (const Effect effect : all_effects)
    if (own.has(effect))
      text += line(name_of(effect), judge(scene, effect),
                   on.has(effect)          ? "on"
                   : available.has(effect) ? "off"
                                           : "off, no data",
                   table_of_effects[std::size_t(effect)].cost);
  for (const NotModelled& other : not_modelled(scene, own))
    text += line(other.name, other.verdict, "not modelled", "-");
  return text + "  error: estimated, of leaving the effect out; cost: a particle and step, from "
                "docs/effects.md\n";
}

EffectWatch::EffectWatch(EffectSet own, EffectSet available, EffectSet on)
    : own_(own), available_(available), on_(on) {}

bool EffectWatch::would_be_due(long step) const {
  return step < last_look_ || step >= last_look_ + until_next_; // it has come, or steps are reset
}

bool EffectWatch::due(long step) {
  constexpr long longest = 1000;
  if (!would_be_due(step))
    return false;
  last_look_ = step;
  until_next_ = std::min(4 * until_next_, longest);
  return true;
}

void EffectWatch::begin(const SceneState& scene) {
  told_.clear();
  static_cast<void>(warnings(scene));
}

std::string EffectWatch::warnings(const SceneState& scene) {
  if (scene.particles.count == 0)
    return {};
  std::string text;
  const auto tell = [&](std::string_view name, const Verdict& v, const char* why) {
    if (!v.counts() || std::ranges::find(told_, name) != told_.end())
      return;
    told_.push_back(name);
    text += fmt::format("granflux: WARNING: the effect {}, which is {}, now counts: {} is {:.3g}, "
                        "above {:.3g}; the error without it is about {} %\n",
                        name, why, v.number, v.value, v.threshold, percent(v.error));
  };
  for (const Effect effect : all_effects)
    if (own_.has(effect) && !on_.has(effect))
      tell(name_of(effect), judge(scene, effect),
           available_.has(effect) ? "off" : "off for want of data");
  for (const NotModelled& other : not_modelled(scene, own_))
    tell(other.name, other.verdict, "not modelled");
  return text;
}

void add_particles(SceneState& scene, const ParticleSpans& p, Vec3 gravity, MPI_Comm comm) {
  struct Sums {
    double count = 0, squares = 0, cubes = 0, mass = 0, energy = 0;
    std::array<double, 3> place{}, place_squared{};
  } sums;
  for (std::size_t i = 0; i < p.position.size(); ++i) {
    const double d = 2 * p.radius[i];
    sums.count += 1;
    sums.squares += d * d;
    sums.cubes += d * d * d;
    sums.mass += p.mass[i];
    sums.energy += dot(p.velocity[i], p.velocity[i]);
    for (int axis = 0; axis < 3; ++axis) {
      const double x = p.position[i][axis];
      sums.place[std::size_t(axis)] += x;
      sums.place_squared[std::size_t(axis)] += x * x;
    }
  }
  static_assert(sizeof sums % sizeof(double) == 0);
  MPI_Allreduce(MPI_IN_PLACE, &sums, int(sizeof sums / sizeof(double)), MPI_DOUBLE, MPI_SUM, comm);

  scene.gravity = norm(gravity);
  coupling::ParticlesOfScene& of = scene.particles;
  of = {};
  of.count = sums.count;
  if (of.count == 0)
    return;
  constexpr double sixth = 3.14159265358979323846 / 6;
  of.diameter = sums.cubes / sums.squares;
  of.density = sums.mass / (sixth * sums.cubes);
  of.speed = std::sqrt(sums.energy / sums.count);
  // A box of the same moments as the cloud of particles.
  double volume = 1;
  Vec3 sides;
  for (int axis = 0; axis < 3; ++axis) {
    const double mean = sums.place[std::size_t(axis)] / sums.count;
    const double variance =
        std::max(0.0, sums.place_squared[std::size_t(axis)] / sums.count - mean * mean);
    sides[axis] = std::sqrt(12 * variance) + of.diameter;
    volume *= sides[axis];
  }
  of.solid_fraction = std::min(0.74, sixth * sums.cubes / volume); // no packing is denser
  of.height =
      scene.gravity > 0
          ? std::abs(dot(sides, {std::abs(gravity.x), std::abs(gravity.y), std::abs(gravity.z)})) /
                scene.gravity
          : std::max({sides.x, sides.y, sides.z});
}

void add_slip(SceneState& scene, std::span<const Vec3> velocity,
              std::span<const coupling::FluidState> fluid, MPI_Comm comm) {
  double sums[] = {0, 0}; // coupled particles, their slips
  for (std::size_t i = 0; i < fluid.size(); ++i)
    if (fluid[i].void_fraction > 0) {
      sums[0] += 1;
      sums[1] += norm(fluid[i].gas_velocity - velocity[i]);
    }
  MPI_Allreduce(MPI_IN_PLACE, sums, 2, MPI_DOUBLE, MPI_SUM, comm);
  if (scene.gas && sums[0] > 0)
    scene.gas->slip = sums[1] / sums[0];
}

std::string heat_cost(EffectSet on, HeatSeconds seconds, MPI_Comm comm) {
  double sums[] = {seconds.near, seconds.step, seconds.particle_steps};
  MPI_Allreduce(MPI_IN_PLACE, sums, 3, MPI_DOUBLE, MPI_SUM, comm);
  if (sums[2] == 0)
    return {};
  std::string text = "granflux: measured cost of heat, ns a particle and step\n";
  const auto row = [&](const char* name, double spent) {
    text += fmt::format("  {:<42}{:>11.2f}\n", name, 1e9 * spent / sums[2]);
  };
  if (on.has(Effect::gas_gap) || on.has(Effect::radiation))
    row("gas_gap, radiation", sums[0]);
  row("step of temperature, convection", sums[1]);
  if (on.has(Effect::conduction) || on.has(Effect::friction) || on.has(Effect::damping))
    text += "  conduction, friction and damping are part of the contact loop: docs/effects.md\n";
  return text;
}

void add_near_heat(coupling::HeatOfScene& heat, const particle_subset::NearHeatOptions& near,
                   std::span<const double> emissivity) {
  if (near.gas_gap) {
    heat.gap_conductivity = near.gas_gap->conductivity;
    heat.gap_layer = near.gas_gap->layer;
    heat.least_gap = near.gas_gap->least_gap;
  }
  if (!emissivity.empty())
    heat.emissivity = *std::ranges::max_element(emissivity);
}

void add_temperatures(SceneState& scene, std::span<const double> temperature, MPI_Comm comm) {
  constexpr double none = std::numeric_limits<double>::infinity();
  double extremes[] = {none, none}; // lowest; highest, negative
  for (const double t : temperature) {
    extremes[0] = std::min(extremes[0], t);
    extremes[1] = std::min(extremes[1], -t);
  }
  MPI_Allreduce(MPI_IN_PLACE, extremes, 2, MPI_DOUBLE, MPI_MIN, comm);
  if (extremes[0] == none)
    return;
  scene.meets(extremes[0]);
  scene.meets(-extremes[1]);
}

} // namespace granflux::driver
