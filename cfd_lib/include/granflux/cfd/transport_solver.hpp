// SPDX-FileCopyrightText: 2026 The GranFlux developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <granflux/cfd/boundary.hpp>
#include <granflux/cfd/diffusion_solver.hpp>
#include <granflux/cfd/halo.hpp>

namespace granflux::cfd {

/// Corrections for implicit convection and diffusion: solves
///   inertia q + 1/2 upwind(q) - 1/2 diffusion(q) = defect
/// with first-order upwind convection, whose matrix is diagonally dominant at any Courant number.
/// The scheme of higher order is in the defect, which the caller makes small by repeating.
/// Stabilised biconjugate gradients with the diagonal as preconditioner (van der Vorst, SIAM J.
/// Sci. Stat. Comput. 13 (1992) 631-644).
class TransportSolver {
public:
  TransportSolver(const Mesh& mesh, const Halo& halo, const Boundaries& boundaries);

  /// `factor` times the fluxes is what is carried: density, or heat capacity per volume. Keeps
  /// references to inertia and conductance until the next call. Collective.
  void set_operator(const BlockFields& inertia, const FaceConductance& conductance,
                    const std::vector<std::array<Field, 3>>& flux, double factor);

  /// Adds to the unknown until what is left of `defect` has shrunk by `reduction`, or to `enough`
  /// (norm). Returns iterations; throws NumericalError on all ranks where that takes more than
  /// 1000. Collective.
  int solve(const Unknown& unknown, BlockFields& defect, double reduction, double enough);

private:
  void multiply(const Unknown& unknown, BlockFields& q, BlockFields& image);
  template <class Term> [[nodiscard]] double sum(Term&& term) const;

  const Mesh& mesh_;
  const Halo& halo_;
  const Boundaries& boundaries_;
  const BlockFields* inertia_ = nullptr;
  const FaceConductance* conductance_ = nullptr;
  FaceConductance carried_; ///< half of what crosses each face; 0 on boundaries [kg/s or W/K]
  BlockFields outflow_;     ///< half of what leaves a cell through boundaries
  BlockFields diagonal_, shadow_, direction_, scaled_, image_, image_of_scaled_;
};

} // namespace granflux::cfd
