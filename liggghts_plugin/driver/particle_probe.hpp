// SPDX-FileCopyrightText: 2026 The GranFlux developers
// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

#include <mpi.h>
#include <string>

#include <granflux/coupling/particle_view.hpp>

namespace granflux::driver {

/// What a look at all particles finds before they meet the gas, over all ranks.
struct ParticleProbe {
  bool good = true;
  double speed = 0;                        ///< largest [m/s]
  double speed_over_radius = 0;            ///< largest [1/s]
  double least_radius = 0, least_mass = 0; ///< 0 without particles
  double largest_radius = 0;               ///< m
  /// Of those that nothing holds [kg/m3]; 0 without any.
  double least_density = 0;
};

/// Which particles are not to be believed: position, velocity, force or temperature not a number,
/// temperature below 0 K, a force that moves its free particle by more than its radius within one
/// step (a contact that no step resolves), and, with `judge_path`, a velocity that does.
struct ParticleJudge {
  double time_step = 0; ///< s
  bool judge_path = false;

  /// One loop over the particles, one reduction. Collective. view.force: all but that of the gas.
  [[nodiscard]] ParticleProbe look(const coupling::ParticleView& view, MPI_Comm comm) const;
  /// The first particle of this rank that is not to be believed, with place and values; empty where
  /// there is none.
  [[nodiscard]] std::string complaint(const coupling::ParticleView& view) const;
};

} // namespace granflux::driver
