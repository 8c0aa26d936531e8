// SPDX-FileCopyrightText: 2026 The GranFlux developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <granflux/cfd/boundary.hpp>
#include <granflux/cfd/halo.hpp>
#include <granflux/cfd/mesh.hpp>

namespace granflux::cfd {

/// Viscous conductances mu eps_f |S|^2/(S.dx) on low faces [kg/s], per local block and direction.
using FaceConductance = std::vector<std::array<Field, 3>>;

/// out = sum over faces of conductance * (q_neighbour - q_cell): a divergence, so that it sums to
/// what crosses the boundaries. Ghosts of q must be filled.
void diffusion(const Layout& layout, const std::array<Field, 3>& conductance, const Field& q,
               Field& out);

/// Solves  inertia u - 1/2 diffusion(u) = rhs  for one velocity component by conjugate gradients
/// with the diagonal as preconditioner.
class ViscousSolver {
public:
  ViscousSolver(const Mesh& mesh, const Halo& halo, const Boundaries& boundaries);

  /// `defect` = rhs - inertia u + 1/2 diffusion(u) on entry, with u's true boundary values; adds
  /// to u (component m) until the defect is `tolerance` of `scale` (its norm). Returns iterations;
  /// throws NumericalError where it takes more than 1000. Collective.
  int solve(int m, const BlockFields& inertia, const FaceConductance& conductance,
            BlockFields& defect, double scale, double tolerance, BlockVectors& u);

private:
  const Mesh& mesh_;
  const Halo& halo_;
  const Boundaries& boundaries_;
  BlockFields direction_, image_, diagonal_;
};

} // namespace granflux::cfd
