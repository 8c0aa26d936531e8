// SPDX-FileCopyrightText: 2026 The GranFlux developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>

#include <granflux/cfd/boundary.hpp>
#include <granflux/cfd/convection.hpp>
#include <granflux/cfd/face_sum.hpp>
#include <granflux/cfd/gradient.hpp>
#include <granflux/cfd/row_sweep.hpp>

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

/// What the fluxes carry out of a cell.
template <class Scheme> class Convection {
public:
  Convection(const Layout& layout, const std::array<Field, 3>& flux,
             const std::array<Field, 3>& weight)
      : stride_(layout.stride) {
    for (std::size_t d = 0; d < 3; ++d)
      flux_[d] = flux[d].data(), weight_[d] = weight[d].data();
  }
  /// Out of cell c; q has both layers of ghosts.
  double operator()(const double* q, std::ptrdiff_t c) const {
    return through(0, q, c + 1) - through(0, q, c) + through(1, q, c + stride_[1]) -
           through(1, q, c) + through(2, q, c + stride_[2]) - through(2, q, c);
  }
  /// Through the low face of cell c, along +d.
  double through(std::size_t d, const double* q, std::ptrdiff_t c) const {
    const std::ptrdiff_t s = stride_[d];
    const double f = flux_[d][c], w = weight_[d][c], low = q[c - s], high = q[c];
    constexpr Scheme scheme;
    if constexpr (!Scheme::looks_upwind)
      return f * scheme(0, low, high, w);
    const double beyond_low = q[c - 2 * s], beyond_high = q[c + s];
    return f >= 0 ? f * scheme(beyond_low, low, high, w)
                  : f * scheme(beyond_high, high, low, 1 - w);
  }

private:
  std::array<const double*, 3> flux_, weight_;
  std::array<std::ptrdiff_t, 3> stride_;
};

/// body(scheme) with the scheme of that name.
template <class Body> void with_scheme(ConvectionScheme name, Body&& body) {
  switch (name) {
  case ConvectionScheme::central:
    return body(Central{});
  case ConvectionScheme::upwind2:
    return body(Upwind2{});
  case ConvectionScheme::limited:
    return body(Limited{});
  }
}

/// On the faces of boundaries the value is that of the condition, not what the scheme makes of
/// ghosts: changed(face, patch, more) for what leaves a cell more by it. Returns what leaves
/// through this rank's boundaries.
template <class Scheme, class Changed>
double convect_boundaries(Scheme, const Mesh& mesh, const Boundaries& boundaries,
                          const FaceFields& flux, const Carried& carried, Changed&& changed) {
  double outflow = 0;
  for (const BoundaryPatch& patch : boundaries.patches()) {
    const auto b = std::size_t(patch.block), d = std::size_t(patch.direction);
    const BoundaryCondition& condition = boundaries.condition(patch);
    const Convection<Scheme> flow(mesh.local[b].layout, flux[b], mesh.local[b].weight);
    const bool outlet = condition.kind == BoundaryKind::outlet;
    const Field& q = carried.at(b);
    for (const BoundaryFace& face : patch.faces) {
      const double f = flux[b][d][face.face];
      if (f == 0)
        continue;
      double value = 0.5 * (q[face.cell] + q[face.ghost]);
      if (outlet && f * patch.outward < 0)
        value = carried.backflow(condition);
      const double leaves = patch.outward * carried.factor * f * value;
      outflow += leaves;
      changed(patch, face,
              leaves - patch.outward * carried.factor * flow.through(d, q.data(), face.face));
    }
  }
  return outflow;
}

/// One sweep over all local blocks; returns what leaves through this rank's boundaries. `work` is
/// used where the mesh is not orthogonal.
inline double convect(ConvectionScheme name, const Mesh& mesh, const Boundaries& boundaries,
                      const FaceFields& flux, const Carried& carried, FaceFields& work) {
  double outflow = 0;
  with_scheme(name, [&]<class Scheme>(Scheme scheme) {
    for (std::size_t b = 0; b < mesh.local.size(); ++b) {
      const Block& block = mesh.local[b];
      const Convection<Scheme> flow(block.layout, flux[b], block.weight);
      for_rows(block.layout, [&, q = carried.at(b).data(), out = carried.out(b).data(),
                              n = block.layout.cells[0]](std::ptrdiff_t row, int, int) {
#pragma omp simd
        for (std::ptrdiff_t c = row; c < row + n; ++c)
          out[c] = carried.factor * flow(q, c);
      });
    }
    outflow =
        convect_boundaries(scheme, mesh, boundaries, flux, carried,
                           [&](const BoundaryPatch& patch, const BoundaryFace& face, double more) {
                             carried.out(std::size_t(patch.block))[face.cell] += more;
                           });
  });
  if (!carried.gradient)
    return outflow;
  for (std::size_t b = 0; b < mesh.local.size(); ++b) { // from where a value is to a face's centre
    const Block& block = mesh.local[b];
    for (std::size_t d = 0; d < 3; ++d)
      for_faces(block.layout, int(d), [&, s = block.layout.stride[d]](std::ptrdiff_t f) {
        work[b][d][f] = carried.factor * flux[b][d][f] *
                        along(block.skew->offset[d], (*carried.gradient)[b], block.weight[d], f, s);
      });
  }
  for (const BoundaryPatch& patch : boundaries.patches())
    for (const BoundaryFace& face : patch.faces)
      work[std::size_t(patch.block)][std::size_t(patch.direction)][face.face] = 0;
  for (std::size_t b = 0; b < mesh.local.size(); ++b) {
    const FaceSum net(mesh.local[b].layout, work[b]);
    Field& out = carried.out(b);
    for_cells(mesh.local[b].layout, [&](std::ptrdiff_t c) { out[c] += net(c); });
  }
  return outflow;
}

} // namespace granflux::cfd
