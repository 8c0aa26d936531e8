// SPDX-FileCopyrightText: 2026 The GranFlux developers
// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

#include <optional>
#include <string_view>

#include "contact.hpp"
#include "material.hpp"

namespace granflux::particle_subset {

/// Normal force of one contact of types a and b by the law of that name, outside all loops; nothing
/// where there is no such law here.
[[nodiscard]] std::optional<NormalForce>
normal_force(std::string_view law, const Material& material, int a, int b, const Contact& contact);

/// Whether the law of that name goes with sqrt(reduced radius) overlap^1.5.
[[nodiscard]] bool is_hertzian(std::string_view law);

} // namespace granflux::particle_subset
