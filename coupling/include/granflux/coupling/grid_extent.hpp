// SPDX-FileCopyrightText: 2026 The GranFlux developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>

#include <granflux/cfd/vec3.hpp>

namespace granflux::coupling {

/// The box around a gas grid.
struct GridExtent {
  Vec3 low, high; ///< m
  std::array<bool, 3> periodic{};
};

} // namespace granflux::coupling
