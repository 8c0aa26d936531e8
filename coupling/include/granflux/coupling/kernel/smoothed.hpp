// SPDX-FileCopyrightText: 2026 The GranFlux developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <granflux/coupling/kernel/spline_kernel.hpp>

namespace granflux::coupling {

/// Trilinear deposit (on grids fitted to bodies: into the cell of the centre), then conservative
/// diffusion of the gas fields over a length set in particle diameters (Smoothing): the void
/// fraction no longer depends on the cell size, and cells may be smaller than particles.
struct Smoothed : SplineKernel<2> {
  static constexpr std::string_view name = "smoothed";
  static constexpr bool smooths = true;
  static constexpr int parts = 1; ///< on grids fitted to bodies

  using SplineKernel<2>::operator();
  template <class Emit>
  Room operator()(const BlockLocator& blocks, const ParticlePlace& particle, Emit&& emit) const {
    emit(particle.cell, 1.0);
    return {.ball = float(blocks.room(particle.cell, particle.centre))};
  }
};

} // namespace granflux::coupling
