// SPDX-FileCopyrightText: 2026 The GranFlux developers
// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

#include <string_view>

#include "../contact.hpp"
#include "../material.hpp"

namespace granflux::particle_subset {

struct RollingOff {
  static constexpr std::string_view name = "off";
  static constexpr bool acts = false, rubs = false;
  static constexpr int history = 0;
  struct Constants {};
  static Constants constants(const Material&, int, int) { return {}; }
};

} // namespace granflux::particle_subset
