// SPDX-FileCopyrightText: 2026 The GranFlux developers
// SPDX-License-Identifier: BSD-3-Clause
#include <granflux/cfd/gradient.hpp>

#include <granflux/cfd/sweep.hpp>

#include "block_geometry.hpp"

namespace granflux::cfd {

std::array<Vec3, 3> dual_vectors(const Block& block, std::ptrdiff_t c) {
  std::array<Vec3, 3> way, dual; // half the way from the neighbour below to the one above
  for (std::size_t d = 0; d < 3; ++d)
    way[d] = 0.5 * (get(block.centre, c + block.layout.stride[d]) -
                    get(block.centre, c - block.layout.stride[d]));
  const double determinant = dot(way[0], cross(way[1], way[2]));
  for (std::size_t d = 0; d < 3; ++d)
    dual[d] = cross(way[(d + 1) % 3], way[(d + 2) % 3]) / determinant;
  return dual;
}

void gradient(const Mesh& mesh, const Halo& halo, const Boundaries& boundaries, const FieldOf& q,
              BlockVectors& out) {
  for (std::size_t b = 0; b < mesh.local.size(); ++b) {
    const Block& block = mesh.local[b];
    const Field& values = q(b);
    VectorField& grad = out[b];
    const auto set_cell = [&](std::ptrdiff_t c, const std::array<Vec3, 3>& dual) {
      Vec3 sum;
      for (std::size_t d = 0; d < 3; ++d) {
        const std::ptrdiff_t s = block.layout.stride[d];
        sum += (0.5 * (values[c + s] - values[c - s])) * dual[d];
      }
      set(grad, c, sum);
    };
    if (block.skew)
      for_cells(block.layout, [&](std::ptrdiff_t c) {
        set_cell(c, {get(block.skew->dual[0], c), get(block.skew->dual[1], c),
                     get(block.skew->dual[2], c)});
      });
    else
      for_cells(block.layout, [&](std::ptrdiff_t c) { set_cell(c, dual_vectors(block, c)); });
  }
  halo.exchange(out);
  for (const BoundaryPatch& patch : boundaries.patches())
    for (const BoundaryFace& face : patch.faces)
      for (Field& component : out[std::size_t(patch.block)])
        component[face.ghost] = component[face.cell];
}

} // namespace granflux::cfd
