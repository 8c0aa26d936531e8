// SPDX-FileCopyrightText: 2026 The GranFlux developers
// SPDX-License-Identifier: GPL-2.0-or-later

#include "heat_options.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>

#include <fmt/core.h>

#include <granflux/cfd/error.hpp>
#include <granflux/cfd/nearest_name.hpp>

namespace granflux::driver {

namespace {

using particle_subset::FrictionHeat;

const std::vector<std::string> keywords{"initial_temperature",
                                        "conduction",
                                        "friction",
                                        "damping",
                                        "wall_share",
                                        "gas_gap",
                                        "gas_layer",
                                        "least_gap",
                                        "radiation",
                                        "fixed_temperature",
                                        "effects",
                                        "heat_every",
                                        "work"};

double number(const std::string& key, const std::string& word, double low, double high,
              const char* allowed) {
  double value = 0;
  const char* end = word.data() + word.size();
  const auto [last, fault] = std::from_chars(word.data(), end, value);
  if (fault != std::errc() || last != end || !std::isfinite(value) || value < low || value > high)
    throw ConfigError(fmt::format("{} {}: must be {}", key, word, allowed));
  return value;
}

int count(const std::string& key, const std::string& word, int most) {
  int value = 0;
  const char* end = word.data() + word.size();
  const auto [last, fault] = std::from_chars(word.data(), end, value);
  if (fault != std::errc() || last != end || value < 1 || value > most)
    throw ConfigError(fmt::format("{} {}: must be a whole number from 1 to {}", key, word, most));
  return value;
}

bool switched_on(const std::string& key, const std::string& word) {
  if (word != "on" && word != "off")
    throw ConfigError(fmt::format("{} {}: must be on or off", key, word));
  return word == "on";
}

FrictionHeat friction_heat(const std::string& word) {
  if (word == "slider")
    return FrictionHeat::slider;
  if (word == "speed")
    return FrictionHeat::speed;
  if (word == "off")
    return FrictionHeat::off;
  throw ConfigError(fmt::format("friction {}: must be slider, speed or off", word));
}

bool is_sampled(const std::string& word) {
  if (word != "exact" && word != "sampled")
    throw ConfigError(fmt::format("work {}: must be exact or sampled", word));
  return word == "sampled";
}

} // namespace

std::span<const std::string> heat_keywords() {
  return keywords;
}

EffectSet HeatOptions::available() const {
  EffectSet set;
  const auto add_if = [&](bool condition, Effect effect) {
    if (condition)
      set.add(effect);
  };
  add_if(contacts.radius.has_value(), Effect::conduction);
  add_if(contacts.friction != FrictionHeat::off, Effect::friction);
  add_if(contacts.damping, Effect::damping);
  add_if(near.gas_gap.has_value(), Effect::gas_gap);
  add_if(near.surroundings.has_value(), Effect::radiation);
  return set;
}

void HeatOptions::keep(EffectSet on) {
  if (!on.has(Effect::conduction))
    contacts.radius.reset();
  if (!on.has(Effect::friction))
    contacts.friction = FrictionHeat::off;
  if (!on.has(Effect::damping))
    contacts.damping = false;
  if (!on.has(Effect::gas_gap))
    near.gas_gap.reset();
  if (!on.has(Effect::radiation))
    near.surroundings.reset();
}

namespace {

/// Dashpots need no data: they are there for who names them, and for the numbers to judge.
void check_named(HeatOptions& options, bool damping_given) {
  const EffectsWanted& wanted = options.effects;
  if (wanted.given() && !damping_given)
    options.contacts.damping =
        wanted.by == EffectsWanted::By::numbers || wanted.named.has(Effect::damping);
  if (wanted.by != EffectsWanted::By::hand)
    return;
  constexpr std::pair<Effect, const char*> needs[] = {
      {Effect::conduction, "conduction off was given"},
      {Effect::friction, "friction off was given"},
      {Effect::damping, "damping off was given"},
      {Effect::gas_gap, "keyword gas_gap is missing: the conductivity of the gas [W/(m K)]"},
      {Effect::radiation, "keyword radiation is missing: the temperature of the surroundings [K]"}};
  for (const auto& [effect, why] : needs)
    if (wanted.named.has(effect) && !options.available().has(effect))
      throw ConfigError(fmt::format("effects {}: {}", name_of(effect), why));
  options.keep(wanted.named);
}

} // namespace

HeatOptions read_heat_options(std::span<char*> given) {
  HeatOptions options;
  std::vector<char*> words(given.begin(), given.end());
  options.effects = take_effects(words, effects_of_heat, keywords);
  bool damping_given = false;
  coupling::GasGap gap{.conductivity = 0};
  std::string of_gap;
  options.contacts.radius = coupling::HertzRadius{};
  for (std::size_t i = 0; i < words.size(); i += 2) {
    const std::string key = words[i];
    if (std::ranges::find(keywords, key) == keywords.end())
      throw ConfigError(fmt::format("unknown keyword {}: {}", key, name_hint(key, keywords)));
    if (i + 1 == words.size())
      throw ConfigError(fmt::format("keyword {} has no value", key));
    const std::string value = words[i + 1];
    if (key == "initial_temperature")
      options.initial_temperature =
          number(key, value, 1e-3, 1e5, "a temperature from 0.001 to 1e5 K");
    else if (key == "conduction" && value == "off")
      options.contacts.radius.reset();
    else if (key == "conduction")
      options.contacts.radius = coupling::ContactRadii::make("conduction (or off)", value);
    else if (key == "friction")
      options.contacts.friction = friction_heat(value);
    else if (key == "damping")
      damping_given = true, options.contacts.damping = switched_on(key, value);
    else if (key == "heat_every")
      options.every = count(key, value, 1000);
    else if (key == "work")
      options.sampled = is_sampled(value);
    else if (key == "wall_share")
      options.contacts.wall_share = number(key, value, 0, 1, "a share from 0 to 1");
    else if (key == "gas_gap")
      gap.conductivity = value == "off" ? 0
                                        : number(key, value, 1e-6, 1e3,
                                                 "off or a conductivity from 1e-6 to 1e3 W/(m K)");
    else if (key == "gas_layer")
      of_gap = key, gap.layer = number(key, value, 1e-3, 1, "from 0.001 to 1 of the radius");
    else if (key == "least_gap")
      of_gap = key, gap.least_gap = number(key, value, 1e-12, 1e-3, "from 1e-12 to 1e-3 m");
    else if (key == "radiation" && value == "off")
      options.near.surroundings.reset();
    else if (key == "radiation")
      options.near.surroundings =
          number(key, value, 0, 1e5, "off or the temperature of the surroundings, 0 to 1e5 K");
    else
      options.fixed_groups.push_back(value);
  }
  if (gap.conductivity > 0)
    options.near.gas_gap = gap;
  else if (!of_gap.empty())
    throw ConfigError(fmt::format("{} is of no use without gas_gap: give the conductivity of the "
                                  "gas [W/(m K)]",
                                  of_gap));
  check_named(options, damping_given);
  if (options.sampled && options.every == 1)
    throw ConfigError("work sampled is of no use without heat_every: temperatures take every step");
  if (options.initial_temperature == 0)
    throw ConfigError("keyword initial_temperature is missing: K");
  return options;
}

} // namespace granflux::driver
