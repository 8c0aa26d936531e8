// SPDX-FileCopyrightText: 2026 The GranFlux developers
// SPDX-License-Identifier: GPL-2.0-or-later

#include "heat_words.hpp"

#include <algorithm>
#include <charconv>
#include <string>
#include <utility>

#include <fmt/core.h>

#include <granflux/cfd/error.hpp>

namespace granflux::lammps {

namespace {

double number(const std::string& key, const std::string& word, double above, double below) {
  double value = 0;
  const char* end = word.data() + word.size();
  const auto [last, fault] = std::from_chars(word.data(), end, value);
  if (fault != std::errc() || last != end || !(value > above && value < below))
    throw ConfigError(
        fmt::format("{} {}: must be a number between {} and {}", key, word, above, below));
  return value;
}

/// A property of every type, with its bounds.
struct Property {
  const char* key;
  double above, below;
  std::vector<double> values;
};

/// Keywords of the fix that need what LAMMPS does not hand on.
void refuse_what_lammps_has_not(const std::string& key, const std::string& value) {
  if (key == "friction" && value == "slider")
    throw ConfigError("friction slider: LAMMPS does not hand its tangential springs on: must be "
                      "speed (with pair_style gran/hooke) or off");
  if (key == "damping" && value == "on")
    throw ConfigError("damping on: LAMMPS does not hand its dashpots on one by one: must be off");
  if (key == "wall_share" || key == "work" || key == "gas_gap" || key == "gas_layer" ||
      key == "least_gap" || key == "radiation")
    throw ConfigError(fmt::format("{}: with LIGGGHTS only (program granflux)", key));
}

} // namespace

namespace {

/// Takes the keyword effects out of the words; returns it as it is handed on to the shared
/// keywords.
std::vector<std::string> effects_of(std::vector<char*>& words,
                                    std::span<const Property> properties) {
  std::vector<std::string> keywords(driver::heat_keywords().begin(), driver::heat_keywords().end());
  for (const Property& property : properties)
    keywords.emplace_back(property.key);
  const driver::EffectsWanted wanted =
      driver::take_effects(words, driver::effects_of_heat, keywords);
  for (const driver::Effect effect :
       {driver::Effect::damping, driver::Effect::gas_gap, driver::Effect::radiation})
    if (wanted.named.has(effect))
      throw ConfigError(fmt::format("effects {}: with LIGGGHTS only (program granflux)",
                                    driver::name_of(effect)));
  if (!wanted.given())
    return {};
  std::vector<std::string> given{"effects"};
  if (wanted.by == driver::EffectsWanted::By::numbers)
    given.emplace_back("auto");
  else if (!wanted.named.any())
    given.emplace_back("none");
  for (const driver::Effect effect : {driver::Effect::conduction, driver::Effect::friction})
    if (wanted.named.has(effect))
      given.emplace_back(driver::name_of(effect));
  return given;
}

} // namespace

HeatWords read_heat_words(std::span<char*> all_words, int types) {
  constexpr double large = 1e15;
  Property properties[] = {{"thermal_capacity", 0, large, {}},
                           {"thermal_conductivity", 0, large, {}},
                           {"youngs_modulus", 0, large, {}},
                           {"poissons_ratio", -1, 0.5, {}}};
  auto& [capacity, conductivity, young, poisson] = properties;

  std::vector<char*> words(all_words.begin(), all_words.end());
  std::vector<std::string> effects = effects_of(words, properties);
  std::string friction = "friction", off = "off"; // what LAMMPS can always have
  std::vector<char*> shared{friction.data(), off.data()};
  for (std::size_t i = 0; i < words.size();) {
    const std::string key = words[i];
    Property* own = nullptr;
    for (Property& property : properties)
      if (key == property.key)
        own = &property;
    if (!own) {
      if (i + 1 < words.size())
        refuse_what_lammps_has_not(key, words[i + 1]);
      for (std::size_t end = std::min(i + 2, words.size()); i < end; ++i)
        shared.push_back(words[i]);
      continue;
    }
    if (i + std::size_t(types) >= words.size())
      throw ConfigError(fmt::format("{} needs {} values, one a type", key, types));
    own->values.clear();
    for (int type = 0; type < types; ++type)
      own->values.push_back(number(key, words[++i], own->above, own->below));
    ++i;
  }

  HeatWords read;
  for (std::string& word : effects)
    shared.push_back(word.data());
  read.options = driver::read_heat_options(shared);
  read.options.contacts.damping = false; // LAMMPS does not hand its dashpots on
  if (read.options.every > 1 &&
      read.options.contacts.friction != particle_subset::FrictionHeat::off)
    throw ConfigError(
        fmt::format("heat_every {}: needs friction off: the heat of friction is found "
                    "contact by contact in every time step",
                    read.options.every));
  const auto need = [](const Property& property, const char* why) {
    if (property.values.empty())
      throw ConfigError(fmt::format("keyword {} is missing: {}", property.key, why));
  };
  const auto& radius = read.options.contacts.radius;
  need(capacity, "J/(kg K), one value a type");
  if (radius || read.options.contacts.friction != particle_subset::FrictionHeat::off)
    need(conductivity, "W/(m K), one value a type");
  if (radius && std::visit([](const auto& r) { return r.needs_force; }, *radius)) {
    need(young, "the true modulus of conduction hertz and geometric, Pa, one value a type");
    need(poisson, "of conduction hertz and geometric, one value a type");
  }
  read.knows_moduli = !young.values.empty() && !poisson.values.empty();
  read.capacity = std::move(capacity.values);
  const auto value = [](const Property& property, std::size_t type, double otherwise) {
    return property.values.empty() ? otherwise : property.values[type];
  };
  for (std::size_t type = 0; type < std::size_t(types); ++type)
    read.materials.push_back({.conductivity = value(conductivity, type, 1),
                              .young = value(young, type, 1),
                              .poisson = value(poisson, type, 0)});
  return read;
}

} // namespace granflux::lammps
