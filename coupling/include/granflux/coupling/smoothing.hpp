// SPDX-FileCopyrightText: 2026 The GranFlux developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <initializer_list>
#include <vector>

#include <granflux/cfd/halo.hpp>
#include <granflux/cfd/mesh.hpp>

namespace granflux::coupling {

/// Coarse graining by diffusion (Sun and Xiao, Int. J. Multiphase Flow 77 (2015) 142-157): a field
/// is let diffuse with D over a time T, which spreads a point to exp(-x^2/b^2), b = sqrt(4 D T),
/// a Gaussian of standard deviation b / sqrt(2). Zero flux through boundaries.
///
/// The sub-steps are explicit and each cell gives away at most half of what it holds, so that the
/// operator S conserves sum f V, is symmetric, <g, S f>_V = <S g, f>_V with <g, f>_V = sum g f V,
/// leaves a constant alone and creates no new extremum.
class Smoothing {
public:
  /// `width` is b [m]; 0 is no smoothing. Throws ConfigError if it is negative or not finite.
  /// Collective. Mesh and halo must outlive this.
  Smoothing(const cfd::Mesh& mesh, const cfd::Halo& halo, double width);

  /// f := S f for each of the fields (each on all local blocks), together. Fills interior cells;
  /// ghosts are left stale. Collective.
  void apply(std::initializer_list<cfd::BlockFields*> fields);

  [[nodiscard]] int substeps() const { return substeps_; }

private:
  const cfd::Mesh& mesh_;
  const cfd::Halo& halo_;
  int substeps_ = 0;
  /// exchange_[b][d]: volume that the low face in direction d swaps each sub-step [m3]
  std::vector<cfd::VectorField> exchange_;
  std::vector<cfd::BlockFields> next_; ///< one set per field, kept from call to call
};

} // namespace granflux::coupling
