// SPDX-FileCopyrightText: 2026 The GranFlux developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <granflux/coupling/kernel/spline_kernel.hpp>

namespace granflux::coupling {

/// Quadratic in each direction in the cell of the centre and its two neighbours, with a slope that
/// has no jump: neither d(eps)/dt nor the gas velocity it asks for jumps where a particle passes a
/// cell's centre or face, so that the pressure stays bounded as the step goes to 0.
struct Spline : SplineKernel<3> {
  static constexpr std::string_view name = "spline";
  static constexpr bool smooths = false;
};

} // namespace granflux::coupling
