// SPDX-FileCopyrightText: 2026 The GranFlux developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>
#include <vector>

#include <granflux/cfd/mesh.hpp>
#include <granflux/cfd/pressure_solver.hpp>

namespace granflux::cfd {

/// One multigrid cycle for A = the negated left-hand side of PressureSystem, as a symmetric
/// positive definite preconditioner (docs/theory.md, "Pressure solver").
///
/// Levels are made of joined cells (coarsening.hpp), fixed at construction; their coefficients are
/// sums of fine ones over the distance that has grown. The smoother is a Chebyshev polynomial in
/// A scaled by its diagonal, so nothing depends on the order of cells, on blocks or on threads.
class Multigrid {
public:
  Multigrid(const Mesh& mesh, bool singular);
  ~Multigrid();

  /// Collective, once for every system; keeps references to its coefficients. Throws
  /// NumericalError on all ranks where a cell has no positive coefficient.
  void setup(const PressureSystem& system);

  /// Collective: the cycle applied to `residual`. The result lasts until the next call.
  const BlockFields& apply(const BlockFields& residual);

  /// image = A q on interior cells; fills the ghosts of q behind links, and takes those at
  /// boundaries for 0. Returns the dot product of q and image over all ranks. Collective.
  double multiply(BlockFields& q, BlockFields& image);

  /// Cells of all blocks on each level, finest first.
  [[nodiscard]] std::vector<long> level_sizes() const;

private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

} // namespace granflux::cfd
