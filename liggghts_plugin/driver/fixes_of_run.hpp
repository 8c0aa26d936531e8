// SPDX-FileCopyrightText: 2026 The GranFlux developers
// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

#include <span>
#include <string>
#include <string_view>

#include <fmt/core.h>

#include <granflux/cfd/error.hpp>

namespace granflux::driver {

// Over the class Modify of a host, whose fixes are in the order of the script.

template <class Modify> auto fixes_of(const Modify& modify) {
  return std::span(modify.fix, std::size_t(modify.nfix));
}

/// The first one of that class, or null.
template <class Wanted, class Modify> Wanted* find_fix(const Modify& modify) {
  for (auto* fix : fixes_of(modify))
    if (auto* found = dynamic_cast<Wanted*>(fix))
      return found;
  return nullptr;
}

/// While a fix is made, which is not among them yet: throws ConfigError where there is one of its
/// style already. `why`: behind the ID of that one.
template <class Modify>
void refuse_second_fix(const Modify& modify, std::string_view style, std::string_view why) {
  for (const auto* fix : fixes_of(modify))
    if (fix && fix->style == style)
      throw ConfigError(fmt::format("fix {} is one already{}", fix->id, why));
}

} // namespace granflux::driver
