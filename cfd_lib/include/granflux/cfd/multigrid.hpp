// SPDX-FileCopyrightText: 2026 The GranFlux developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>
#include <vector>

#include <granflux/cfd/level_field.hpp>
#include <granflux/cfd/mesh.hpp>
#include <granflux/cfd/pressure_solver.hpp>

namespace granflux::cfd {

/// One multigrid cycle for A = the negated left-hand side of PressureSystem, as a symmetric
/// positive definite preconditioner (docs/theory.md, "Pressure solver"), in single precision.
///
/// Levels are made of joined cells (coarsening.hpp), fixed at construction; their coefficients are
/// sums of fine ones over the distance that has grown. The smoother is a Chebyshev polynomial in
/// A scaled by its diagonal, so nothing depends on the order of cells, on blocks or on threads.
class Multigrid {
public:
  Multigrid(const Mesh& mesh, bool singular);
  ~Multigrid();

  /// Collective, once for every system; costs little where the coefficients are those of the
  /// system before. Throws NumericalError on all ranks where a cell has no positive coefficient.
  void setup(const PressureSystem& system);

  /// The power of 2 by which the coefficients are multiplied, to suit single precision.
  [[nodiscard]] double scale() const;
  [[nodiscard]] const LevelLayout& layout(std::size_t block) const;
  /// Of a local block: what apply() works on. The largest should be near 1.
  float* residual(std::size_t block);
  /// Collective: correction = about inverse(scale A) residual, ghosts behind links filled; it
  /// lasts until the next call. Returns their product over all ranks.
  double apply();
  [[nodiscard]] const float* correction(std::size_t block) const;

  /// Cells of all blocks on each level, finest first.
  [[nodiscard]] std::vector<long> level_sizes() const;

private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

} // namespace granflux::cfd
