// SPDX-FileCopyrightText: 2026 The GranFlux developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>

#include <granflux/cfd/boundary.hpp>
#include <granflux/cfd/diffusion_solver.hpp>
#include <granflux/cfd/mesh.hpp>

namespace granflux::cfd {

/// The part of div(kappa grad q) that two-point conductances do not see on a mesh that is not
/// orthogonal: the sum over faces of kappa cross . grad q, added to `out(b)`. `conductance` is
/// kappa |S|^2/(S.dx) on low faces; `given` says of which boundaries the value of q is known
/// (through others the flux is, and nothing is added). `work` is scratch space on faces.
/// Returns what enters through this rank's boundaries.
double add_cross_diffusion(const Mesh& mesh, const Boundaries& boundaries,
                           const FaceConductance& conductance, const BlockVectors& grad,
                           const std::function<bool(const BoundaryCondition&)>& given,
                           FaceConductance& work, const std::function<Field&(std::size_t)>& out);

} // namespace granflux::cfd
