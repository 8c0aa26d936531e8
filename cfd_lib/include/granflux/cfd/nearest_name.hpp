// SPDX-FileCopyrightText: 2026 The GranFlux developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <numeric>
#include <string>
#include <string_view>
#include <vector>

namespace granflux {

/// Edits (insert, delete, replace a letter) that turn one word into the other: the Levenshtein
/// distance, row by row of its table.
[[nodiscard]] inline std::size_t edit_distance(std::string_view a, std::string_view b) {
  std::vector<std::size_t> row(b.size() + 1), next(b.size() + 1);
  std::iota(row.begin(), row.end(), std::size_t{0});
  for (std::size_t i = 0; i < a.size(); ++i) {
    next[0] = i + 1;
    for (std::size_t j = 0; j < b.size(); ++j)
      next[j + 1] = std::min({row[j + 1] + 1, next[j] + 1, row[j] + (a[i] != b[j])});
    row.swap(next);
  }
  return row.back();
}

/// What to tell about an unknown name: "did you mean density?" where one of the known names is
/// close, else "known are: density, viscosity".
[[nodiscard]] inline std::string name_hint(std::string_view unknown,
                                           const std::vector<std::string>& known) {
  const std::string* nearest = nullptr;
  std::size_t least = std::max<std::size_t>(1, unknown.size() / 3) + 1;
  for (const std::string& name : known)
    if (const std::size_t distance = edit_distance(unknown, name); distance < least)
      least = distance, nearest = &name;
  if (nearest)
    return "did you mean " + *nearest + "?";
  std::string all;
  for (const std::string& name : known)
    all += (all.empty() ? "known are: " : ", ") + name;
  return all.empty() ? "none is known here" : all;
}

} // namespace granflux
