// SPDX-FileCopyrightText: 2026 The GranFlux developers
// SPDX-License-Identifier: GPL-2.0-or-later

#include "gran_words.hpp"

#include <algorithm>
#include <array>
#include <string_view>

namespace granflux::particle_subset {

namespace {

/// Options of the laws that exist by particle subset. Heating options only fill a number that
/// LIGGGHTS 3.8.0 reads nowhere.
constexpr std::array<std::string_view, 10> supported{
    "tangential_damping",   "absolute_damping",
    "limitForce",           "ktToKnUser",
    "torsionTorque",        "tangential_reduce",
    "heating_tracking",     "heating_normal_hooke",
    "heating_normal_hertz", "heating_tangential_history",
};

} // namespace

bool GranWords::option(std::string_view keyword) const {
  const auto given = options.find(keyword);
  return given == options.end() ? keyword == "tangential_damping" : given->second;
}

std::string GranWords::unsupported_option() const {
  for (const auto& [keyword, on] : options)
    if (on && std::ranges::find(supported, keyword) == supported.end())
      return keyword;
  return {};
}

GranWords read_gran_words(std::span<char*> words) {
  GranWords read;
  for (std::size_t w = 0; w < words.size(); w += 2) {
    const std::string key = words[w];
    if (w + 1 == words.size()) {
      read.malformed = key;
      break;
    }
    const std::string value = words[w + 1];
    if (key == "model")
      read.laws.normal = value;
    else if (key == "tangential")
      read.laws.tangential = value;
    else if (key == "rolling_friction")
      read.laws.rolling = value;
    else if (key == "cohesion")
      read.laws.cohesion = value;
    else if (key == "surface")
      read.surface = value;
    else if (value == "on" || value == "off")
      read.options[key] = value == "on";
    else
      read.malformed = key;
  }
  return read;
}

} // namespace granflux::particle_subset
