// SPDX-FileCopyrightText: 2026 The GranFlux developers
// SPDX-License-Identifier: BSD-3-Clause
#include "gas_state.hpp"

#include <granflux/cfd/convection.hpp>

namespace granflux::cfd {

/// Inertia moves with the fluxes that will carry momentum in this step, so that a uniform velocity
/// stays uniform however the void fraction moves, and momentum is still conserved.
void GasSolver::Impl::extrapolate_inertia(double dt) {
  for (std::size_t b = 0; b < mesh.local.size(); ++b)
    for_cells(mesh.local[b].layout, [&](std::ptrdiff_t c) {
      eps_inertia[b][c] += dt * (ab_now * eps_rate[b][c] + ab_old * eps_rate_old[b][c]);
    });
}

template <class Scheme> void GasSolver::Impl::convect(const Scheme& scheme) {
  const double rho = fluid.density;
  for (std::size_t m = 0; m < 3; ++m) {
    for (std::size_t b = 0; b < mesh.local.size(); ++b) {
      const Block& block = mesh.local[b];
      const Field& q = u[b][m];
      for (std::size_t d = 0; d < 3; ++d) {
        const std::ptrdiff_t s = block.layout.stride[d];
        const Field &f = flux[b][d], &w = block.weight[d];
        Field& carried = face_work[b][d];
        for_faces(block.layout, int(d), [&, s](std::ptrdiff_t c) {
          const double value = f[c] >= 0 ? scheme(q[c - 2 * s], q[c - s], q[c], w[c])
                                         : scheme(q[c + s], q[c], q[c - s], 1 - w[c]);
          carried[c] = rho * f[c] * value;
        });
      }
    }
    double through = 0;
    for (const BoundaryPatch& patch : boundaries.patches()) {
      const auto b = std::size_t(patch.block), d = std::size_t(patch.direction);
      const bool outlet = boundaries.condition(patch).kind == BoundaryKind::outlet;
      for (const BoundaryFace& face : patch.faces) {
        const double f = flux[b][d][face.face];
        double value = 0.5 * (u[b][m][face.cell] + u[b][m][face.ghost]);
        if (outlet && f * patch.outward < 0)
          value = 0; // backflow: gas outside is at rest
        face_work[b][d][face.face] = rho * f * value;
        through += patch.outward * face_work[b][d][face.face];
      }
    }
    outflow[int(m)] = through;
    for (std::size_t b = 0; b < mesh.local.size(); ++b) {
      const auto [si, sj, sk] = mesh.local[b].layout.stride;
      const auto& [fi, fj, fk] = face_work[b];
      Field& out = convection[b][m];
      for_cells(mesh.local[b].layout,
                [&, si = si, sj = sj, sk = sk, &fi = fi, &fj = fj, &fk = fk](std::ptrdiff_t c) {
                  out[c] = fi[c + si] - fi[c] + fj[c + sj] - fj[c] + fk[c + sk] - fk[c];
                });
    }
  }
}

void GasSolver::Impl::convect() {
  std::swap(convection, convection_old);
  outflow_old = outflow;
  switch (numerics.convection) {
  case ConvectionScheme::central:
    return convect(Central{});
  case ConvectionScheme::upwind2:
    return convect(Upwind2{});
  case ConvectionScheme::limited:
    return convect(Limited{});
  }
}

} // namespace granflux::cfd
