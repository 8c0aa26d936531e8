// SPDX-FileCopyrightText: 2026 The GranFlux developers
// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

#include <vector>

namespace LAMMPS_NS {
class Atom;
class Modify;
} // namespace LAMMPS_NS

namespace granflux::particle_subset {

/// Brings the particles of a rank into the order of their places: cell by cell, along the shortest
/// extent of the particles first and along the longest last. Neighbours are then no further apart
/// in memory than the smallest cross-section of the bed has cells, and the threads' ranges are
/// slabs across its longest extent, which share the fewest pairs and have equal parts of a floor.
class SpatialOrder {
public:
  /// Cells are cubes of `size` metres, larger where there would be far more of them than particles.
  /// Particles of one cell keep their order. Not collective; there must be no ghosts.
  void sort(LAMMPS_NS::Atom& atom, LAMMPS_NS::Modify& modify, double size);

private:
  std::vector<int> start_; // of each cell
  std::vector<int> cell_;  // of each particle
  std::vector<int> from_;  // the old number of each new one
};

} // namespace granflux::particle_subset
