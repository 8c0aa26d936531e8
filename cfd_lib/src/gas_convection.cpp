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

/// Inertia moves with the fluxes that will carry momentum in this step, so that a uniform velocity
/// stays uniform however the void fraction moves, and momentum is still conserved.
void GasSolver::Impl::move_inertia(double dt, double of_last, const BlockFields& other,
                                   double of_other) {
  const BlockFields& last = implicit ? eps_rate_old : eps_rate;
  for (std::size_t b = 0; b < mesh.local.size(); ++b)
    for_cells(mesh.local[b].layout, [&](std::ptrdiff_t c) {
      eps_inertia[b][c] += dt * (of_last * last[b][c] + of_other * other[b][c]);
    });
}

/// Momentum that leaves each cell with the fluxes and the velocity as they are [N]; returns what
/// leaves through this rank's boundaries.
Vec3 GasSolver::Impl::convect_momentum(BlockVectors& out) {
  Vec3 leaving;
  for (std::size_t m = 0; m < 3; ++m) {
    const Carried carried{
        .at = [&](std::size_t b) -> const Field& { return u[b][m]; },
        .out = [&](std::size_t b) -> Field& { return out[b][m]; },
        .factor = fluid.density,
        .backflow = [](const BoundaryCondition&) { return 0.0; }, // gas outside is at rest
        .gradient = mesh.orthogonal ? nullptr : &velocity_gradient[m]};
    leaving[int(m)] = convect(numerics.convection, mesh, boundaries, flux, carried, face_work);
  }
  return leaving;
}

} // namespace granflux::cfd
