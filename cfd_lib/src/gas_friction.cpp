// SPDX-FileCopyrightText: 2026 The GranFlux developers
// SPDX-License-Identifier: BSD-3-Clause
#include <granflux/cfd/cross_diffusion.hpp>

#include "eddy_viscosity.hpp"
#include "gas_state.hpp"

namespace granflux::cfd {

void GasSolver::Impl::set_conductance() {
  if (resting() && eddy_viscosity.empty())
    return;
  if (fluid.smagorinsky > 0)
    set_smagorinsky(mesh, halo, boundaries, fluid, velocity_gradient, eddy_viscosity);
  for (std::size_t b = 0; b < mesh.local.size(); ++b) {
    const Block& block = mesh.local[b];
    for (std::size_t d = 0; d < 3; ++d) {
      const std::ptrdiff_t s = block.layout.stride[d];
      for_faces(block.layout, int(d), [&, s](std::ptrdiff_t f) {
        double viscosity = fluid.viscosity;
        if (!eddy_viscosity.empty())
          viscosity += on_face(eddy_viscosity[b], block.weight[d], f, s);
        conductance[b][d][f] =
            viscosity * block.conductance[d][f] * on_face(eps_start[b], block.weight[d], f, s);
      });
    }
  }
}

/// Force of the boundaries on this rank's gas, component m, but for what only meshes that are not
/// orthogonal and eddies have [N].
double GasSolver::Impl::friction_at_boundaries(std::size_t m) const {
  double force = 0;
  for (const BoundaryPatch& patch : boundaries.patches()) {
    const auto b = std::size_t(patch.block), d = std::size_t(patch.direction);
    for (const BoundaryFace& face : patch.faces)
      force += conductance[b][d][face.face] * (u[b][m][face.ghost] - u[b][m][face.cell]);
  }
  return force;
}

/// Viscous force on each cell for component m of the velocity as it is, ghosts filled and gradient
/// up to date [N]; returns the part that comes through this rank's boundaries.
double GasSolver::Impl::viscous_force(std::size_t m, BlockFields& out) {
  const auto field = [&](std::size_t b) -> Field& { return out[b]; };
  for (std::size_t b = 0; b < mesh.local.size(); ++b)
    diffusion(mesh.local[b].layout, conductance[b], u[b][m], out[b]);
  double force = friction_at_boundaries(m);
  if (!mesh.orthogonal)
    force += add_cross_diffusion(
        mesh, boundaries, conductance, velocity_gradient[m],
        [](const BoundaryCondition& c) {
          return c.kind == BoundaryKind::wall || c.kind == BoundaryKind::inlet;
        },
        face_work, field);
  if (!eddy_viscosity.empty())
    add_transposed_stress(mesh, eddy_viscosity, eps_start, velocity_gradient, boundaries, m,
                          face_work, field);
  return force;
}

} // namespace granflux::cfd
