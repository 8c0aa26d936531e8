// SPDX-FileCopyrightText: 2026 The GranFlux developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>

#include <granflux/cfd/boundary.hpp>
#include <granflux/cfd/convection.hpp>
#include <granflux/cfd/face_sum.hpp>
#include <granflux/cfd/gradient.hpp>
#include <granflux/cfd/sweep.hpp>

namespace granflux::cfd {

using FaceFields = std::vector<std::array<Field, 3>>; ///< per local block and direction

/// What the fluxes carry of one scalar: `at(b)` and `out(b)` give its field and that of the result.
struct Carried {
  std::function<const Field&(std::size_t)> at; ///< with both layers of ghosts
  std::function<Field&(std::size_t)> out;      ///< what leaves each cell: factor sum(F q_f)
  double factor = 1;                           ///< density, or heat capacity per volume
  /// Value that gas brings back through an outlet.
  std::function<double(const BoundaryCondition&)> backflow;
  /// Its gradient, where the mesh is not orthogonal: moves the value to the face's centre.
  const BlockVectors* gradient = nullptr;
};

/// One sweep over all local blocks; returns what leaves through this rank's boundaries.
template <class Scheme>
double convect(const Scheme& scheme, const Mesh& mesh, const Boundaries& boundaries,
               const FaceFields& flux, const Carried& carried, FaceFields& work) {
  for (std::size_t b = 0; b < mesh.local.size(); ++b) {
    const Block& block = mesh.local[b];
    const Field& q = carried.at(b);
    for (std::size_t d = 0; d < 3; ++d) {
      const std::ptrdiff_t s = block.layout.stride[d];
      const Field &f = flux[b][d], &w = block.weight[d];
      Field& through = work[b][d];
      for_faces(block.layout, int(d), [&, s](std::ptrdiff_t c) {
        const double value = f[c] >= 0 ? scheme(q[c - 2 * s], q[c - s], q[c], w[c])
                                       : scheme(q[c + s], q[c], q[c - s], 1 - w[c]);
        through[c] = carried.factor * f[c] * value;
      });
      if (carried.gradient)
        for_faces(block.layout, int(d), [&, s](std::ptrdiff_t c) {
          through[c] +=
              carried.factor * f[c] * along(block.skew->offset[d], (*carried.gradient)[b], w, c, s);
        });
    }
  }
  double outflow = 0;
  for (const BoundaryPatch& patch : boundaries.patches()) {
    const auto b = std::size_t(patch.block), d = std::size_t(patch.direction);
    const BoundaryCondition& condition = boundaries.condition(patch);
    const bool outlet = condition.kind == BoundaryKind::outlet;
    const Field& q = carried.at(b);
    for (const BoundaryFace& face : patch.faces) {
      const double f = flux[b][d][face.face];
      double value = 0.5 * (q[face.cell] + q[face.ghost]);
      if (outlet && f * patch.outward < 0)
        value = carried.backflow(condition);
      work[b][d][face.face] = carried.factor * f * value;
      outflow += patch.outward * work[b][d][face.face];
    }
  }
  for (std::size_t b = 0; b < mesh.local.size(); ++b) {
    const FaceSum net(mesh.local[b].layout, work[b]);
    Field& out = carried.out(b);
    for_cells(mesh.local[b].layout, [&](std::ptrdiff_t c) { out[c] = net(c); });
  }
  return outflow;
}

/// The same with a scheme chosen by name.
inline double convect(ConvectionScheme scheme, const Mesh& mesh, const Boundaries& boundaries,
                      const FaceFields& flux, const Carried& carried, FaceFields& work) {
  switch (scheme) {
  case ConvectionScheme::central:
    return convect(Central{}, mesh, boundaries, flux, carried, work);
  case ConvectionScheme::upwind2:
    return convect(Upwind2{}, mesh, boundaries, flux, carried, work);
  case ConvectionScheme::limited:
    break;
  }
  return convect(Limited{}, mesh, boundaries, flux, carried, work);
}

} // namespace granflux::cfd
