// SPDX-FileCopyrightText: 2026 The GranFlux developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include <granflux/cfd/boundary.hpp>
#include <granflux/cfd/mesh.hpp>

namespace granflux::cfd {

/// Conductances on low faces, per local block and direction: mu eps_f |S|^2/(S.dx) [kg/s] for
/// momentum, k eps_f |S|^2/(S.dx) [W/K] for heat.
using FaceConductance = std::vector<std::array<Field, 3>>;

/// Sum over the faces of a cell of conductance * (q_neighbour - q_cell): a divergence, so that it
/// sums to what crosses the boundaries. Ghosts of q must be filled.
class Diffusion {
public:
  Diffusion(const Layout& layout, const std::array<Field, 3>& conductance)
      : gi_(conductance[0].data()), gj_(conductance[1].data()), gk_(conductance[2].data()),
        sj_(layout.stride[1]), sk_(layout.stride[2]) {}
  double operator()(const double* q, std::ptrdiff_t c) const {
    const double here = q[c];
    return gi_[c + 1] * (q[c + 1] - here) - gi_[c] * (here - q[c - 1]) +
           gj_[c + sj_] * (q[c + sj_] - here) - gj_[c] * (here - q[c - sj_]) +
           gk_[c + sk_] * (q[c + sk_] - here) - gk_[c] * (here - q[c - sk_]);
  }
  /// Conductance to all neighbours.
  [[nodiscard]] double faces(std::ptrdiff_t c) const {
    return gi_[c] + gi_[c + 1] + gj_[c] + gj_[c + sj_] + gk_[c] + gk_[c + sk_];
  }

private:
  const double *gi_, *gj_, *gk_;
  std::ptrdiff_t sj_, sk_;
};

/// Diffusion of a whole block.
void diffusion(const Layout& layout, const std::array<Field, 3>& conductance, const Field& q,
               Field& out);

/// One unknown of a system: where it lies, what bounds its corrections, what to call it.
struct Unknown {
  std::string name;                            ///< for messages
  std::function<Field&(std::size_t block)> at; ///< by index into Mesh::local
  /// Of a correction in the ghost cell behind a boundary face, in units of that inside: 1 where
  /// nothing passes, -1 where the value on the face is given.
  std::function<double(const BoundaryPatch&, const BoundaryFace&)> ghost_factor;
};

/// Corrects a solution of  inertia q - 1/2 diffusion(q) = rhs  by Chebyshev iteration with the
/// diagonal as preconditioner, in single precision. Gershgorin's circles give the spectrum, 1 +-
/// the largest share of diffusion in a diagonal, and with it the number of steps: no sums over
/// cells within the iteration, and no sweep to see whether it was enough.
class DiffusionSolver {
public:
  DiffusionSolver(const Mesh& mesh, const Boundaries& boundaries);
  ~DiffusionSolver();

  /// For the corrections that follow; keeps a reference to the inertia [kg/s or W/K]. Collective.
  void set_operator(const BlockFields& inertia, const FaceConductance& conductance);

  struct Report {
    int iterations = 0;
    double left = 0; ///< bound of the norm of the defect
  };
  /// `defect` = rhs - inertia q + 1/2 diffusion(q), of the norm `size`, with q's true boundary
  /// values. Adds to q what leaves a defect of the norm `enough`, or what single precision can
  /// tell: then the report's `left` is more than enough, and the defect must be taken anew. Throws
  /// NumericalError where that takes more than 5000 steps. Collective.
  Report correct(const Unknown& unknown, const BlockFields& defect, double size, double enough);

private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

} // namespace granflux::cfd
