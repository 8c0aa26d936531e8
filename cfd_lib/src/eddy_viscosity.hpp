// SPDX-FileCopyrightText: 2026 The GranFlux developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>

#include <granflux/cfd/boundary.hpp>
#include <granflux/cfd/halo.hpp>
#include <granflux/cfd/mesh.hpp>

namespace granflux::cfd {

/// Eddy viscosity rho (C V^(1/3))^2 sqrt(2 S_ij S_ij) [Pa s] (Smagorinsky, Mon. Weather Rev. 91
/// (1963) 99-164), S the symmetric part of the velocity's gradient; ghosts filled. Collective.
void set_smagorinsky(const Mesh& mesh, const Halo& halo, const Boundaries& boundaries,
                     const Fluid& fluid, const std::array<BlockVectors, 3>& velocity_gradient,
                     BlockFields& eddy_viscosity);

/// Adds div(eps mu_t (grad u)^T), component m, to `out` [N]: the part of the stress that vanishes
/// only where the viscosity is uniform. Nothing of it crosses boundaries.
void add_transposed_stress(const Mesh& mesh, const BlockFields& eddy_viscosity,
                           const BlockFields& void_fraction,
                           const std::array<BlockVectors, 3>& velocity_gradient,
                           const Boundaries& boundaries, std::size_t m,
                           std::vector<std::array<Field, 3>>& work,
                           const std::function<Field&(std::size_t)>& out);

} // namespace granflux::cfd
