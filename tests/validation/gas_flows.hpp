// SPDX-FileCopyrightText: 2026 The GranFlux developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include <granflux/cfd/gas_case.hpp>

/// Flows of the gas alone with published solutions, and what is measured on them. All are planes of
/// one cell's depth, made dimensionless, on one rank.
namespace granflux::cfd::validation {

/// Square cavity of side 1: cells along each side, drawn together towards the walls.
struct CavityGrid {
  int cells = 32;
  double stretching = 0; ///< b of the node positions tanh(b (2 s - 1)) / tanh b; 0: all equal
};

/// How long a run that is to become steady goes on.
struct Steadiness {
  TimeScheme time_scheme = TimeScheme::semi_implicit;
  double courant = 0.6;
  /// Largest change of a velocity component in a unit of time, over the largest speed.
  double change = 1e-5;
  double most_time = 200;
};

struct Sample {
  double coordinate, value;
};

struct LidCavity {
  std::vector<Sample> u; ///< along the lid's motion, on the vertical middle line, from the floor up
  std::vector<Sample> v; ///< upwards, on the horizontal middle line
  double time = 0;       ///< when steady
  long steps = 0;
};

/// Lid at speed 1. `viscosity_factor` is there to be wrong by.
LidCavity lid_cavity(double reynolds, const CavityGrid& grid, const Steadiness& steadiness,
                     double viscosity_factor = 1);

/// Value at a coordinate of a middle line: the cubic through the four nearest samples.
double at(const std::vector<Sample>& line, double coordinate);

struct HeatedCavity {
  double nusselt = 0;             ///< mean over the hot wall
  double nusselt_cold = 0;        ///< the same over the cold one
  double u_max = 0, u_max_at = 0; ///< on the vertical middle line
  double v_max = 0, v_max_at = 0; ///< on the horizontal one
  double time = 0;
  long steps = 0;
};

/// Hot wall left, cold wall right, Prandtl number 0.71; lengths in the side, velocities in
/// alpha / side.
HeatedCavity heated_cavity(double rayleigh, const CavityGrid& grid, const Steadiness& steadiness,
                           double buoyancy_factor = 1);

/// Ring of cells around a cylinder of diameter 1, in a stream of speed 1 along x.
struct CylinderGrid2D {
  int tangential = 96;
  double outer_radius = 25;
  double first = 0.02;  ///< width of the cells at the cylinder
  double growth = 1.07; ///< of the cells outwards
  double wake = 0.5;    ///< radius up to which cells do not grow beyond `widest`
  double widest = 0.05;
  double gather = 0;        ///< share by which cells on the wake's axis are narrower than the mean
  double outlet_angle = 60; ///< degrees either side of x where the gas leaves
};

struct ForceSample {
  double time, drag, lift; ///< coefficients, by speed 1 and diameter 1
};

struct CylinderFlow {
  std::vector<ForceSample> history;
  double drag = 0;          ///< at the end, or the mean of whole periods
  double pressure_drag = 0; ///< share of it at the end
  double wake_length = 0;   ///< from the rear of the cylinder, in radii; 0: none
  double lift = 0;          ///< amplitude; 0 where nothing sheds
  double strouhal = 0;
  int periods = 0; ///< that the means are of
  int radial = 0;  ///< cells outwards
  double time = 0;
  long steps = 0;
};

/// Until steady, from the steady flow on cells of twice the size (twice over); `history` has
/// every step on the grid itself.
CylinderFlow steady_cylinder(double reynolds, const CylinderGrid2D& grid,
                             const Steadiness& steadiness);
/// A wake that sheds, until `end_time`; means over its last `periods` periods.
CylinderFlow shedding_cylinder(double reynolds, const CylinderGrid2D& grid, double courant,
                               double end_time, int periods);

} // namespace granflux::cfd::validation
