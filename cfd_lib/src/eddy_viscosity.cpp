// SPDX-FileCopyrightText: 2026 The GranFlux developers
// SPDX-License-Identifier: BSD-3-Clause
#include "eddy_viscosity.hpp"

#include <cmath>

#include <granflux/cfd/face_sum.hpp>
#include <granflux/cfd/sweep.hpp>

namespace granflux::cfd {

void set_smagorinsky(const Mesh& mesh, const Halo& halo, const Boundaries& boundaries,
                     const Fluid& fluid, const std::array<BlockVectors, 3>& velocity_gradient,
                     BlockFields& eddy_viscosity) {
  for (std::size_t b = 0; b < mesh.local.size(); ++b) {
    const Block& block = mesh.local[b];
    for_cells(block.layout, [&](std::ptrdiff_t c) {
      double squares = 0; // 2 S_ij S_ij
      for (std::size_t m = 0; m < 3; ++m)
        for (std::size_t n = 0; n < 3; ++n) {
          const double twice = velocity_gradient[m][b][n][c] + velocity_gradient[n][b][m][c];
          squares += 0.5 * twice * twice;
        }
      const double length = fluid.smagorinsky * std::cbrt(block.volume[c]);
      eddy_viscosity[b][c] = fluid.density * length * length * std::sqrt(squares);
    });
  }
  halo.exchange({&eddy_viscosity});
  boundaries.fill_zero_gradient(eddy_viscosity);
}

void add_transposed_stress(const Mesh& mesh, const BlockFields& eddy_viscosity,
                           const BlockFields& void_fraction,
                           const std::array<BlockVectors, 3>& velocity_gradient,
                           const Boundaries& boundaries, std::size_t m,
                           std::vector<std::array<Field, 3>>& work,
                           const std::function<Field&(std::size_t)>& out) {
  for (std::size_t b = 0; b < mesh.local.size(); ++b) {
    const Block& block = mesh.local[b];
    for (std::size_t d = 0; d < 3; ++d) {
      const std::ptrdiff_t s = block.layout.stride[d];
      const Field& w = block.weight[d];
      const auto on_face = [&, s](const Field& q, std::ptrdiff_t f) {
        return q[f - s] + w[f] * (q[f] - q[f - s]);
      };
      for_faces(block.layout, int(d), [&](std::ptrdiff_t f) {
        double sum = 0; // S_n du_n/dx_m
        for (std::size_t n = 0; n < 3; ++n)
          sum += block.area[d][n][f] * on_face(velocity_gradient[n][b][m], f);
        work[b][d][f] = on_face(eddy_viscosity[b], f) * on_face(void_fraction[b], f) * sum;
      });
    }
  }
  // A boundary's normal velocity varies neither along it nor, by continuity, across it.
  for (const BoundaryPatch& patch : boundaries.patches())
    for (const BoundaryFace& face : patch.faces)
      work[std::size_t(patch.block)][std::size_t(patch.direction)][face.face] = 0;
  for (std::size_t b = 0; b < mesh.local.size(); ++b) {
    const FaceSum net(mesh.local[b].layout, work[b]);
    Field& sum = out(b);
    for_cells(mesh.local[b].layout, [&](std::ptrdiff_t c) { sum[c] += net(c); });
  }
}

} // namespace granflux::cfd
