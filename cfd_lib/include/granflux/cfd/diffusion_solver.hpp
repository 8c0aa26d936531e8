// SPDX-FileCopyrightText: 2026 The GranFlux developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>
#include <string>
#include <vector>

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

/// Solves  inertia q - 1/2 diffusion(q) = rhs  by Chebyshev iteration with the diagonal as
/// preconditioner. Gershgorin's circles give the spectrum: 1 +- the largest share of diffusion in
/// a diagonal. No sums over cells within the iteration: one sweep and one exchange each.
class DiffusionSolver {
public:
  DiffusionSolver(const Mesh& mesh, const Halo& halo);

  /// One unknown of a system: where it lies, what bounds its corrections, what to call it.
  struct Unknown {
    std::string name;                              ///< for messages
    std::function<Field&(std::size_t block)> at;   ///< by index into Mesh::local
    std::function<void(BlockFields&)> fill_ghosts; ///< of a correction: homogeneous conditions
  };

  /// For the solutions that follow; keeps references. Collective.
  void set_operator(const BlockFields& inertia, const FaceConductance& conductance);

  /// `defect` = rhs - inertia q + 1/2 diffusion(q) on entry, with q's true boundary values; adds to
  /// q until what is left of it has the norm `enough`, and leaves that in it. Returns iterations;
  /// throws NumericalError where it takes more than 5000. Collective.
  int solve(const Unknown& unknown, BlockFields& defect, double enough);

private:
  void step(const Unknown& unknown, const BlockFields& defect, double keep, double gain);
  double take_off(const Unknown& unknown, BlockFields& defect);

  const Mesh& mesh_;
  const Halo& halo_;
  const BlockFields* inertia_ = nullptr;
  const FaceConductance* conductance_ = nullptr;
  double half_width_ = 0; ///< of the spectrum about 1
  BlockFields correction_, before_, inverse_diagonal_;
  std::vector<double> room_;
};

} // namespace granflux::cfd
