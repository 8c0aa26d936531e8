// SPDX-FileCopyrightText: 2026 The GranFlux developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <string>
#include <string_view>
#include <variant>

#include <granflux/cfd/error.hpp>

namespace granflux::coupling {

/// The laws of one kind that a user can name. A law is a value with a static `name`; the list makes
/// one by that name, once, and std::visit opens the variant outside the loop over particles. To
/// register a law is to add its type to the list.
template <class... Laws> struct LawList {
  using Any = std::variant<Laws...>;
  static constexpr std::array<std::string_view, sizeof...(Laws)> names{Laws::name...};

  /// Throws ConfigError that lists the known names; `keyword` is what the user wrote it under.
  static Any make(std::string_view keyword, std::string_view name) {
    Any chosen;
    const bool known = ((name == Laws::name && (chosen = Laws{}, true)) || ...);
    if (!known)
      throw ConfigError(unknown(keyword, name));
    return chosen;
  }

  /// Calls visit(law) for each law in turn.
  template <class Visit> static void for_each(Visit&& visit) { (visit(Laws{}), ...); }

private:
  static std::string unknown(std::string_view keyword, std::string_view name) {
    std::string text(keyword);
    text.append(": unknown name '").append(name).append("'; known are");
    for (const auto known : names)
      text.append(" ").append(known);
    return text;
  }
};

} // namespace granflux::coupling
