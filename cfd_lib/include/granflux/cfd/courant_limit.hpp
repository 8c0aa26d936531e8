// SPDX-FileCopyrightText: 2026 The GranFlux developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>

#include <granflux/cfd/gas_case.hpp>
#include <granflux/cfd/mesh.hpp>
#include <granflux/cfd/stable_range.hpp>

namespace granflux::cfd {

/// Largest Courant number (StepReport::courant) at which the semi-implicit scheme, whose convection
/// is explicit, does not amplify any wave; Bound::none for the implicit scheme. By von Neumann's
/// analysis of Adams-Bashforth steps (docs/reference/stable_range.md).
[[nodiscard]] double courant_limit(const Numerics& numerics);

/// Beyond this Courant number a single step multiplies the shortest waves by hundreds: GasSolver
/// stops with the cell's name.
[[nodiscard]] double hopeless_courant(const Numerics& numerics);

/// Largest Courant number per time of a uniform flow [1/s], or, with the inlets of the case at full
/// speed, of the quickest of them: what can be told before the first step. Collective.
[[nodiscard]] double courant_rate(const Mesh& mesh, const Vec3& velocity);
[[nodiscard]] double courant_rate_of_inlets(const Mesh& mesh, const GasCase& gas_case);

/// Rows of a StableRange. `cure`: of the Courant number, from the number.
[[nodiscard]] Bound courant_bound(const Numerics& numerics,
                                  std::function<std::string(double)> cure);
[[nodiscard]] Bound friction_bound();

} // namespace granflux::cfd
