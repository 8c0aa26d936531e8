// SPDX-FileCopyrightText: 2026 The GranFlux developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>
#include <string>

#include <granflux/cfd/halo.hpp>
#include <granflux/cfd/mesh.hpp>

namespace granflux::cfd {

/// Conductances on low faces, per local block and direction: mu eps_f |S|^2/(S.dx) [kg/s] for
/// momentum, k eps_f |S|^2/(S.dx) [W/K] for heat.
using FaceConductance = std::vector<std::array<Field, 3>>;

/// out = sum over faces of conductance * (q_neighbour - q_cell): a divergence, so that it sums to
/// what crosses the boundaries. Ghosts of q must be filled.
void diffusion(const Layout& layout, const std::array<Field, 3>& conductance, const Field& q,
               Field& out);

/// Solves  inertia q - 1/2 diffusion(q) = rhs  by conjugate gradients with the diagonal as
/// preconditioner.
class DiffusionSolver {
public:
  DiffusionSolver(const Mesh& mesh, const Halo& halo);

  /// One unknown of a system: where it lies, what bounds its corrections, what to call it.
  struct Unknown {
    std::string name;                              ///< for messages
    std::function<Field&(std::size_t block)> at;   ///< by index into Mesh::local
    std::function<void(BlockFields&)> fill_ghosts; ///< of a correction: homogeneous conditions
  };

  /// `defect` = rhs - inertia q + 1/2 diffusion(q) on entry, with q's true boundary values; adds to
  /// q until the defect is `tolerance` of `scale` (its norm). Returns iterations; throws
  /// NumericalError where it takes more than 1000. Collective.
  int solve(const Unknown& unknown, const BlockFields& inertia, const FaceConductance& conductance,
            BlockFields& defect, double scale, double tolerance);

private:
  const Mesh& mesh_;
  const Halo& halo_;
  BlockFields direction_, image_, diagonal_;
};

} // namespace granflux::cfd
