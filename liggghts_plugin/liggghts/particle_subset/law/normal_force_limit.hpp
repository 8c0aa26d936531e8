// SPDX-FileCopyrightText: 2026 The GranFlux developers
// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

#include <limits>

#include "../material.hpp"

namespace granflux::particle_subset {

/// Least normal force of a contact: keyword limitForce forbids that damping pulls.
[[nodiscard]] inline double least_normal_force(const Material& material) {
  return material.option("limitForce") ? 0.0 : -std::numeric_limits<double>::infinity();
}

} // namespace granflux::particle_subset
