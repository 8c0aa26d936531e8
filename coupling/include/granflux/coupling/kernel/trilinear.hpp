// SPDX-FileCopyrightText: 2026 The GranFlux developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <granflux/coupling/kernel/spline_kernel.hpp>

namespace granflux::coupling {

/// Linear in each direction between the two nearest cell centres, where the slope of a share jumps.
struct Trilinear : SplineKernel<2> {
  static constexpr std::string_view name = "trilinear";
  static constexpr bool smooths = false;
};

} // namespace granflux::coupling
