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

const std::vector<std::string> keywords{
    "initial_temperature", "conduction", "friction",  "damping",          "wall_share", "gas_gap",
    "gas_layer",           "least_gap",  "radiation", "fixed_temperature"};

double number(const std::string& key, const std::string& word, double low, double high,
              const char* allowed) {
  double value = 0;
  const char* end = word.data() + word.size();
  const auto [last, fault] = std::from_chars(word.data(), end, value);
  if (fault != std::errc() || last != end || !std::isfinite(value) || value < low || value > high)
    throw ConfigError(fmt::format("{} {}: must be {}", key, word, allowed));
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

} // namespace

HeatOptions read_heat_options(std::span<char*> words) {
  HeatOptions options;
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
      options.contacts.damping = switched_on(key, value);
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
  if (options.initial_temperature == 0)
    throw ConfigError("keyword initial_temperature is missing: K");
  return options;
}

} // namespace granflux::driver
