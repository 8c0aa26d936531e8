// SPDX-FileCopyrightText: 2026 The GranFlux developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <mpi.h>
#include <optional>
#include <string>

#include <granflux/cfd/mesh.hpp>

namespace granflux::cfd {

/// A grid in a CGNS file: structured zones in three dimensions, joined one to one (any orientation,
/// periodic by translation), every other face in a boundary condition.
struct CgnsGrid {
  std::string file;            ///< path
  std::string base;            ///< name of the base; empty: the only one
  std::optional<double> scale; ///< m per unit of the file, where it does not tell its unit
};

/// Zones become blocks in the file's order; boundaries are named by the family of a boundary
/// condition, or by its own name where it has none. A left-handed zone is turned by counting k
/// backwards. All ranks read the file's structure; nodes are read as the maps are asked for them,
/// plane by plane, and the file stays open until the last map is gone.
///
/// Collective. Throws ConfigError on all ranks for a file that is missing, no CGNS file or damaged,
/// and for what it holds beyond the above; the text names zone, connection or condition, and the
/// range of faces that have neither.
Grid read_cgns_grid(const CgnsGrid& grid, MPI_Comm comm);

} // namespace granflux::cfd
