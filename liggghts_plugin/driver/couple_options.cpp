// SPDX-FileCopyrightText: 2026 The GranFlux developers
// SPDX-License-Identifier: GPL-2.0-or-later

#include "couple_options.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <vector>

#include <fmt/core.h>

#include <granflux/cfd/error.hpp>
#include <granflux/cfd/nearest_name.hpp>

namespace granflux::driver {

namespace {

template <class Number> bool parse(const std::string& word, Number& value) {
  const char* end = word.data() + word.size();
  const auto result = std::from_chars(word.data(), end, value);
  return result.ec == std::errc() && result.ptr == end;
}

const std::vector<std::string> keywords{"case", "couple_every", "fixed_group",
                                        "box",  "progress",     "effects"};

} // namespace

int read_couple_every(const std::string& word) {
  int n = 0;
  if (!parse(word, n) || n < 1)
    throw ConfigError(
        fmt::format("couple_every {}: must be a whole number of steps, 1 or more", word));
  return n;
}

double read_progress_every(const std::string& word) {
  double seconds = 0;
  if (!parse(word, seconds) || !std::isfinite(seconds) || seconds < 0)
    throw ConfigError(
        fmt::format("progress {}: must be seconds between two lines, 0 for none", word));
  return seconds;
}

CoupleOptions read_couple_options(std::span<char*> given) {
  CoupleOptions options;
  std::vector<char*> words(given.begin(), given.end());
  options.effects = take_effects(words, effects_of_gas, keywords);
  for (std::size_t i = 0; i < words.size(); i += 2) {
    const std::string key = words[i];
    if (std::ranges::find(keywords, key) == keywords.end())
      throw ConfigError(fmt::format("unknown keyword {}: {}", key, name_hint(key, keywords)));
    if (i + 1 == words.size())
      throw ConfigError(fmt::format("keyword {} has no value", key));
    const std::string value = words[i + 1];
    if (key == "case")
      options.case_file = value;
    else if (key == "couple_every")
      options.couple_every = read_couple_every(value);
    else if (key == "fixed_group")
      options.fixed_group = value;
    else if (key == "progress")
      options.progress_every = read_progress_every(value);
    else if (value == "any" || value == "match")
      options.any_box = value == "any";
    else
      throw ConfigError(fmt::format("box {}: must be match or any", value));
  }
  if (options.case_file.empty())
    throw ConfigError("keyword case is missing: the path of the gas case (TOML)");
  if (options.couple_every == 0)
    throw ConfigError("keyword couple_every is missing: particle steps a coupling step");
  return options;
}

} // namespace granflux::driver
