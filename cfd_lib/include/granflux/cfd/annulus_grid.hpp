// SPDX-FileCopyrightText: 2026 The GranFlux developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include <granflux/cfd/axial_frame.hpp>
#include <granflux/cfd/mesh.hpp>

namespace granflux::cfd {

/// Part of the outer circle that is a boundary of its own.
struct Arc {
  std::string name;
  double from = 0,
         to = 0; ///< degrees, from < to <= from + 360; a face belongs to it if its middle does
};

/// Space between two circular cylinders, or a sector of it: the gap of Taylor and Couette, the bend
/// of a pipe wall, and, with a far outer circle, the flow around a cylinder.
///
/// One block; i runs outwards, j around in the sense of AxialFrame, k along the axis. Its
/// boundaries are `inner`, `outer` (or the arcs in its place), `low` and `high` at the ends of the
/// axis unless it is periodic, `start` and `end` where the circle does not close.
struct AnnulusGrid {
  AxialFrame frame;                                      ///< origin at the low end
  double inner_radius = 0, outer_radius = 0, length = 0; ///< m
  int radial = 0, tangential = 0, axial = 0;             ///< cells
  double start_angle = 0, sweep = 360;                   ///< degrees
  double growth = 1;          ///< width of a cell over that of the next one inwards
  bool periodic_axis = false; ///< low and high are connected
  std::vector<Arc> arcs;      ///< together they cover the outer circle; none: `outer`
  /// Nodes one by one, increasing, one more than cells; if given, `radii` [m] take the place of
  /// inner_radius, outer_radius and growth, `angles` [degrees] that of start_angle and sweep.
  std::vector<double> radii, angles;
};

/// Throws ConfigError for radii, lengths, cells or angles that make no annulus, and for arcs that
/// overlap, leave a face bare or match none.
Grid make_annulus(const AnnulusGrid& annulus);

} // namespace granflux::cfd
