// SPDX-FileCopyrightText: 2026 The GranFlux developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <granflux/coupling/kernel/kernel.hpp>

namespace granflux::coupling {

/// The whole particle in the cell of its centre. Fit for particles much smaller than a cell.
struct Centre {
  static constexpr std::string_view name = "centre";
  static constexpr bool smooths = false;
  static constexpr int parts = 1;

  template <class Emit>
  void operator()(const LatticeLocator&, const ParticlePlace& particle, Emit&& emit) const {
    emit(particle.cell, 1.0);
  }
  template <class Emit>
  Room operator()(const BlockLocator& blocks, const ParticlePlace& particle, Emit&& emit) const {
    emit(particle.cell, 1.0);
    return {.ball = float(blocks.room(particle.cell, particle.centre))};
  }
};

} // namespace granflux::coupling
