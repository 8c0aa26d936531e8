// SPDX-FileCopyrightText: 2026 The GranFlux developers
// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

#include <string_view>

namespace granflux::particle_subset {

/// Where the laws find their constants; asked once per run and pair of types.
class Material {
public:
  virtual ~Material() = default;
  /// Of the pair of types a and b, from 1 on, under the name by which the host knows it.
  [[nodiscard]] virtual double pair(std::string_view property, int a, int b) const = 0;
  [[nodiscard]] virtual double scalar(std::string_view property) const = 0;
  /// An on/off keyword of `pair_style gran`, with its default.
  [[nodiscard]] virtual bool option(std::string_view keyword) const = 0;
};

} // namespace granflux::particle_subset
