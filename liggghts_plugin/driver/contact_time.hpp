// SPDX-FileCopyrightText: 2026 The GranFlux developers
// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

#include <functional>
#include <string>
#include <vector>

namespace granflux::driver {

/// Normal force of two touching spheres: a spring with a dashpot.
struct NormalSpring {
  bool hertzian = false; ///< stiffness * overlap, or stiffness * sqrt(reduced radius) * overlap^1.5
  double stiffness = 0;  ///< N/m, or 4/3 of the effective modulus [Pa]
  double damping = 0;    ///< of the linear one [kg/s]
};

/// How long a contact lasts: half a period of the damped oscillator, pi / sqrt(k/m - (c/2m)^2) [s];
/// infinity where it is damped beyond its critical value. `mass`: reduced, m1 m2 / (m1 + m2).
[[nodiscard]] double contact_time(const NormalSpring& linear, double mass);

/// Step beyond which central differences with the dashpot at the last half step's velocity diverge
/// for one contact: 2 (sqrt(1 + z^2) - z) sqrt(m/k), z = c / (2 sqrt(k m)) [s] (Belytschko, in
/// Computational Methods for Transient Analysis, 1983).
[[nodiscard]] double longest_step(const NormalSpring& linear, double mass);

/// The same of Hertz's elastic contact that begins at `speed`: 2.943 overlap / speed with the
/// largest overlap (5 m v^2 / (4 K sqrt(R)))^(2/5) [s] (Johnson, Contact Mechanics, 1985,
/// section 11.4).
[[nodiscard]] double hertz_contact_time(const NormalSpring& hertzian, double mass, double radius,
                                        double speed);

/// Time that a Rayleigh wave takes around half a sphere, pi r sqrt(rho/G) / (0.1631 nu + 0.8766)
/// [s] (Thornton and Randall, in Micromechanics of Granular Materials, 1988). `shear`: modulus
/// [Pa].
[[nodiscard]] double rayleigh_time(double radius, double density, double shear, double poisson);

/// Of the particles of one type, over all ranks.
struct ParticleType {
  double least_radius = 0, least_mass = 0; ///< m, kg; 0: there are none
  double young = 0, poisson = 0;           ///< Pa; 0: the host's contacts know of no modulus
};

/// What of a host's contacts limits its time step. Types count from 1 on.
struct ContactTimes {
  struct Least {
    double seconds = 0; ///< 0: there is none
    int first = 0, second = 0;
  };
  /// Of a spring and dashpot: how long a contact lasts, or pi/2 times its longest step, which is
  /// the same without damping and shorter with it.
  Least linear;
  /// Of a contact that begins at 1 m/s; the time goes with speed^(-1/5).
  Least hertzian;
  Least rayleigh;          ///< of one type
  double least_radius = 0; ///< of any particle [m]; 0 without particles
  std::string unknown;     ///< why nothing is known, or empty

  [[nodiscard]] static double at_speed(const Least& hertzian, double speed);
};

/// The shortest times of all pairs of `types`. `spring`: of a pair of types, for its reduced radius
/// and mass.
[[nodiscard]] ContactTimes
shortest_times(const std::vector<ParticleType>& types,
               const std::function<NormalSpring(int a, int b, double radius, double mass)>& spring);

} // namespace granflux::driver
