// SPDX-FileCopyrightText: 2026 The GranFlux developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <string>

#include <granflux/cfd/case_file.hpp>
#include <granflux/cfd/gas_case.hpp>

namespace granflux::cfd {

/// The table [grid].
GridDescription read_grid(CaseFile& file);

/// Where a [[boundary]] lies: the keys name, side, from, to, angles.
struct BoundaryPlace {
  std::string name;
  std::optional<Side> side; ///< of a box: its plane is known before there is a mesh
};
/// Adds what the table says to the grid: a patch of a box, or an arc of an annulus.
BoundaryPlace read_boundary_place(const CaseTable& table, GridDescription& grid);

} // namespace granflux::cfd
