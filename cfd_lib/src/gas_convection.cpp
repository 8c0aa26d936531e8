// SPDX-FileCopyrightText: 2026 The GranFlux developers
// SPDX-License-Identifier: BSD-3-Clause
#include "gas_state.hpp"

namespace granflux::cfd {

/// From the velocity with its ghosts filled; only where something needs it.
void GasSolver::Impl::update_velocity_gradient() {
  for (std::size_t m = 0; m < 3; ++m)
    if (!velocity_gradient[m].empty())
      gradient(
          mesh, halo, boundaries, [&](std::size_t b) -> const Field& { return u[b][m]; },
          velocity_gradient[m]);
}

/// Component m of the momentum.
Carried GasSolver::Impl::carried_momentum(std::size_t m, BlockVectors& out) {
  return {.at = [this, m](std::size_t b) -> const Field& { return u[b][m]; },
          .out = [m, &out](std::size_t b) -> Field& { return out[b][m]; },
          .factor = fluid.density,
          .backflow = [](const BoundaryCondition&) { return 0.0; }, // gas outside is at rest
          .gradient = mesh.orthogonal ? nullptr : &velocity_gradient[m]};
}

/// Momentum that leaves each cell with the fluxes and the velocity as they are [N]; returns what
/// leaves through this rank's boundaries.
Vec3 GasSolver::Impl::convect_momentum(BlockVectors& out) {
  Vec3 leaving;
  for (std::size_t m = 0; m < 3; ++m)
    leaving[int(m)] =
        convect(numerics.convection, mesh, boundaries, flux, carried_momentum(m, out), face_work);
  return leaving;
}

} // namespace granflux::cfd
