// SPDX-FileCopyrightText: 2026 The GranFlux developers
// SPDX-License-Identifier: BSD-3-Clause
#include "gas_state.hpp"

namespace granflux::cfd {

/// Inertia moves with the fluxes that will carry momentum in this step, so that a uniform velocity
/// stays uniform however the void fraction moves, and momentum is still conserved.
void GasSolver::Impl::extrapolate_inertia(double dt) {
  for (std::size_t b = 0; b < mesh.local.size(); ++b)
    for_cells(mesh.local[b].layout, [&](std::ptrdiff_t c) {
      eps_inertia[b][c] += dt * (ab_now * eps_rate[b][c] + ab_old * eps_rate_old[b][c]);
    });
}

void GasSolver::Impl::convect_momentum() {
  std::swap(convection, convection_old);
  outflow_old = outflow;
  for (std::size_t m = 0; m < 3; ++m) {
    const Carried carried{
        .at = [&](std::size_t b) -> const Field& { return u[b][m]; },
        .out = [&](std::size_t b) -> Field& { return convection[b][m]; },
        .factor = fluid.density,
        .backflow = [](const BoundaryCondition&) { return 0.0; }}; // gas outside is at rest
    outflow[int(m)] = convect(numerics.convection, mesh, boundaries, flux, carried, face_work);
  }
}

} // namespace granflux::cfd
