// SPDX-FileCopyrightText: 2026 The GranFlux developers
// SPDX-License-Identifier: BSD-3-Clause
#include <granflux/cfd/cross_diffusion.hpp>

#include <granflux/cfd/face_sum.hpp>
#include <granflux/cfd/gradient.hpp>
#include <granflux/cfd/sweep.hpp>

namespace granflux::cfd {

double add_cross_diffusion(const Mesh& mesh, const Boundaries& boundaries,
                           const FaceConductance& conductance, const BlockVectors& grad,
                           const std::function<bool(const BoundaryCondition&)>& given,
                           FaceConductance& work, const std::function<Field&(std::size_t)>& out) {
  for (std::size_t b = 0; b < mesh.local.size(); ++b) {
    const Block& block = mesh.local[b];
    for (std::size_t d = 0; d < 3; ++d) {
      const std::ptrdiff_t s = block.layout.stride[d];
      const Field &g = conductance[b][d], &geometric = block.conductance[d], &w = block.weight[d];
      const VectorField& cross = block.skew->cross[d];
      Field& through = work[b][d];
      for_faces(block.layout, int(d), [&, s](std::ptrdiff_t f) {
        through[f] = g[f] / geometric[f] * along(cross, grad[b], w, f, s);
      });
    }
  }
  double entering = 0;
  for (const BoundaryPatch& patch : boundaries.patches()) {
    Field& through = work[std::size_t(patch.block)][std::size_t(patch.direction)];
    const bool known = given(boundaries.condition(patch));
    for (const BoundaryFace& face : patch.faces) {
      if (!known)
        through[face.face] = 0;
      entering += patch.outward * through[face.face];
    }
  }
  for (std::size_t b = 0; b < mesh.local.size(); ++b) {
    const FaceSum net(mesh.local[b].layout, work[b]);
    Field& sum = out(b);
    for_cells(mesh.local[b].layout, [&](std::ptrdiff_t c) { sum[c] += net(c); });
  }
  return entering;
}

} // namespace granflux::cfd
