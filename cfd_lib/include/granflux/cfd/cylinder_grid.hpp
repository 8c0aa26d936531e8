// SPDX-FileCopyrightText: 2026 The GranFlux developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <granflux/cfd/axial_frame.hpp>
#include <granflux/cfd/mesh.hpp>

namespace granflux::cfd {

/// A full cylinder as five blocks across, a core with bulging sides and four around it, times any
/// number along the axis; at the four corners of the core three blocks meet.
///
/// Blocks of a layer along the axis: core, then those at 0, 90, 180 and 270 degrees (AxialFrame).
/// The core's i and j run along p and q; of the others i runs outwards and j around; k always runs
/// along the axis. The boundaries are `wall`, and `low` and `high` at the ends of the axis unless
/// it is periodic.
///
/// core_radius and bulge are chosen so that no cell is much smaller or more skewed than needed:
/// with 10 cells across the core and 5 around, the smallest volume is 0.45 of the largest,
/// neighbours differ by 1.19 at most, and no face is crossed at more than 20 degrees from its
/// normal.
struct CylinderGrid {
  AxialFrame frame;              ///< origin at the low end
  double radius = 0, length = 0; ///< m
  int core = 0;                  ///< cells along each side of the core, and around each outer block
  int radial = 0;                ///< cells of the outer blocks between core and wall
  int axial = 0;                 ///< cells along the axis, all blocks together
  int axial_blocks = 1;
  double core_radius = 0.625; ///< of the core's corners, as share of the radius
  double bulge = 0.3;         ///< sides of the core: 0 straight, 1 arcs of a circle
  double growth = 1;          ///< width of an outer cell over that of the next one inwards
  bool periodic_axis = false; ///< low and high are connected
};

/// Throws ConfigError for sizes, cells or shapes that make no cylinder.
Grid make_cylinder(const CylinderGrid& cylinder);

} // namespace granflux::cfd
