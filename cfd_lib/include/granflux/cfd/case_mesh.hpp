// SPDX-FileCopyrightText: 2026 The GranFlux developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <granflux/cfd/gas_case.hpp>
#include <granflux/cfd/mesh.hpp>

namespace granflux::cfd {

/// The mesh that a case describes, its blocks cut where the number of ranks asks for it.
/// Collective. Throws ConfigError on all ranks: what make_mesh throws, boundaries of the grid and
/// of the case that do not have the same names, a driving pressure gradient along a direction that
/// is not periodic.
Mesh make_mesh(const GasCase& gas_case, MPI_Comm comm);

} // namespace granflux::cfd
