// SPDX-FileCopyrightText: 2026 The GranFlux developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <concepts>
#include <cstddef>
#include <string_view>

#include <granflux/coupling/locate.hpp>

namespace granflux::coupling {

/// The cells one particle touches.
struct ParticlePlace {
  Vec3 centre;        ///< m
  double radius = 0;  ///< m
  cfd::Index3 cell{}; ///< unwrapped cell of the centre
};

/// The most cells that a kernel may share a particle among.
inline constexpr std::size_t most_cells_of_a_particle = 32;

/// The contract of all void-fraction kernels: called with a particle and emit(cell, weight), a
/// kernel emits each cell that gets a share of the particle once, with its unwrapped index triple
/// and weight > 0; most_cells_of_a_particle of them at most. Weights are multiples of 1/K::parts,
/// of 255 parts at most, unless they are products in a cube (SplineKernel). The weights sum to 1 to
/// round-off. Along directions that are not periodic no cell outside the domain is emitted.
/// `smooths`: the coupler passes the deposited fields, and the gas fields it samples, through
/// Smoothing. A kernel that can be called with a BlockLocator too serves grids that are fitted to
/// bodies. A kernel that returns a number says how far the particle may move before any of its
/// shares changes [m].
template <class K>
concept VoidFractionKernel = std::default_initializable<K> &&
    requires(const K kernel, const LatticeLocator& lattice, const ParticlePlace& particle) {
  { K::name } -> std::convertible_to<std::string_view>;
  { K::smooths } -> std::convertible_to<bool>;
  kernel(lattice, particle, [](const cfd::Index3&, double) {});
};

} // namespace granflux::coupling
