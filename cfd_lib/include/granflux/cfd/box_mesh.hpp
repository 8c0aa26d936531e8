// SPDX-FileCopyrightText: 2026 The GranFlux developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include <granflux/cfd/mesh.hpp>

namespace granflux::cfd {

/// A rectangle on a side of the box that carries a boundary condition.
struct BoxPatch {
  std::string name;
  Side side;
  /// Corner coordinates [m]; the coordinate along the side's normal is ignored. A face belongs to
  /// the patch if its centre lies inside.
  Vec3 from{-1e300, -1e300, -1e300}, to{1e300, 1e300, 1e300};
};

struct BoxGrid {
  std::array<std::vector<double>, 3> nodes; ///< node coordinates along x, y, z [m], increasing
  std::array<bool, 3> periodic{};
  Index3 blocks{0, 0, 0}; ///< blocks along each direction; 0: cut so that every rank has one
  std::vector<BoxPatch> patches;
};

/// Nodes of n equal cells from origin to origin + length [m].
std::vector<double> uniform_nodes(double origin, double length, int n);

/// Cuts the box into blocks, deals them to the ranks by cost and connects them. Throws ConfigError
/// where patches overlap, leave a face bare, match no face, or lie on a periodic side.
Mesh make_box_mesh(const BoxGrid& box, MPI_Comm comm);

} // namespace granflux::cfd
