// SPDX-FileCopyrightText: 2026 The GranFlux developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <limits>
#include <optional>

namespace granflux::coupling {

/// The particles of a scene as if all were alike. Zero: unknown or absent.
struct ParticlesOfScene {
  double count = 0;
  double diameter = 0;       ///< Sauter mean: sum d^3 / sum d^2 [m]
  double density = 0;        ///< kg/m3
  double speed = 0;          ///< root mean square [m/s]
  double solid_fraction = 0; ///< where the particles are [-]
  double height = 0;         ///< extent along gravity; the largest without gravity [m]
};

/// The gas beside them.
struct GasOfScene {
  double density = 0;       ///< kg/m3
  double viscosity = 0;     ///< Pa s
  double speed = 0;         ///< largest at inlets and at the start, superficial [m/s]
  double wall_speed = 0;    ///< largest of walls [m/s]
  double length = 0;        ///< longest side of the grid [m]
  double slip = 0;          ///< mean speed relative to particles, where it is solved [m/s]
  double conductivity = 0;  ///< 0: it has no temperature [W/(m K)]
  double heat_capacity = 0; ///< J/(kg K)
  double expansion = 0;     ///< 1/K
  /// Diameter of the scene's particles, if parcels, over that of those they stand for.
  double coarse_graining = 1;

  /// Largest that anything imposes [m/s].
  [[nodiscard]] double driven() const { return std::max(speed, wall_speed); }
};

/// What decides how particles exchange heat with each other.
struct HeatOfScene {
  double heat_capacity = 0; ///< J/(kg K)
  double conductivity = 0;  ///< W/(m K)
  double young = 0;         ///< true modulus [Pa]
  double poisson = 0;
  double emissivity = 1;           ///< 1, which is the most, where it is not known
  double gap_conductivity = 0;     ///< of gas in gaps; 0: taken from the gas [W/(m K)]
  double gap_layer = 0.2;          ///< see GasGap
  double least_gap = 2.75e-8;      ///< m
  double friction_power = 0;       ///< of a particle, as measured; 0: to be estimated [W]
  double friction_coefficient = 1; ///< 1, for an upper bound, where it is not known
};

/// A scene, as far as it decides which effects matter.
struct SceneState {
  ParticlesOfScene particles;
  std::optional<GasOfScene> gas;
  std::optional<HeatOfScene> heat; ///< where particles have temperatures
  double gravity = 0;              ///< m/s2
  double box_length = 0;           ///< longest side of the box [m]
  /// Temperatures of all that exchanges heat: particles, walls, gas, surroundings [K].
  double coldest = std::numeric_limits<double>::infinity();
  double hottest = -std::numeric_limits<double>::infinity();
  bool heated = false; ///< by sources or fluxes whose temperatures are not known beforehand

  void meets(double temperature) {
    coldest = std::min(coldest, temperature);
    hottest = std::max(hottest, temperature);
  }
  /// Difference of temperatures that drives heat [K]. Of sources it is not known: 1 K.
  [[nodiscard]] double span() const {
    const double found = std::max(0.0, hottest - coldest);
    return heated ? std::max(1.0, found) : found;
  }
};

} // namespace granflux::coupling
