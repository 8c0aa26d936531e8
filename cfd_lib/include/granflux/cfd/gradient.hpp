// SPDX-FileCopyrightText: 2026 The GranFlux developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>

#include <granflux/cfd/boundary.hpp>
#include <granflux/cfd/halo.hpp>
#include <granflux/cfd/mesh.hpp>

namespace granflux::cfd {

/// A scalar by local block, so that a component of a vector can stand for one.
using FieldOf = std::function<const Field&(std::size_t block)>;

/// grad q = sum over d of dual[d] (q[+1 along d] - q[-1 along d]) / 2 at cell c [1/m]: exact for
/// linear q whatever the shape of the cells. Needs the centres of the six neighbours.
std::array<Vec3, 3> dual_vectors(const Block& block, std::ptrdiff_t c);

/// grad q in all cells, from q with its first layer of ghosts filled. Ghosts of the result behind
/// links are filled; those behind boundaries get the gradient of their cell. Collective.
void gradient(const Mesh& mesh, const Halo& halo, const Boundaries& boundaries, const FieldOf& q,
              BlockVectors& out);

/// v . (grad q on the face below f), v a vector on faces.
inline double along(const VectorField& v, const VectorField& grad, const Field& weight,
                    std::ptrdiff_t f, std::ptrdiff_t stride) {
  double sum = 0;
  for (std::size_t m = 0; m < 3; ++m)
    sum += v[m][f] * (grad[m][f - stride] + weight[f] * (grad[m][f] - grad[m][f - stride]));
  return sum;
}

} // namespace granflux::cfd
