// SPDX-FileCopyrightText: 2026 The GranFlux developers
// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

#include <map>
#include <span>
#include <string>

#include "contact_kernel.hpp"

namespace granflux::particle_subset {

/// What follows `pair_style gran`: the models and their on/off keywords.
struct GranWords {
  LawNames laws;
  std::string surface = "default";
  std::map<std::string, bool, std::less<>> options; ///< those given
  std::string malformed;                            ///< a word that was not understood, or empty

  [[nodiscard]] bool option(std::string_view keyword) const;
  /// An option that is on and has no form by particle subset, or empty.
  [[nodiscard]] std::string unsupported_option() const;
};

[[nodiscard]] GranWords read_gran_words(std::span<char*> words);

} // namespace granflux::particle_subset
