// SPDX-FileCopyrightText: 2026 The GranFlux developers
// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

#include <vector>

#include <liggghts/fix_nve_sphere.h>

#include "kick.hpp"

namespace granflux::particle_subset {

class Neighbor;

/// fix nve/sphere with every thread moving its own particles. `update dipole` is LIGGGHTS' own.
class FixNveSphere : public LAMMPS_NS::FixNVESphere {
public:
  using LAMMPS_NS::FixNVESphere::FixNVESphere;

  void initial_integrate(int vflag) override;
  void final_integrate() override;

  /// True if the second half of a step may be taken with the first half of the next.
  [[nodiscard]] bool may_owe() const;
  /// In place of final_integrate(): the next initial_integrate() takes that half step too, with one
  /// pass over the particles less. Nobody may look at velocities before.
  void owe_final_integrate() { owed_ = true; }

  /// Before the forces of a step whose final_integrate() will be owed: some of the particles may
  /// move on to the next step by move_ahead() as soon as their forces are complete.
  void may_move_ahead(int threads) { ahead_.assign(std::size_t(threads), {}); }
  /// What is owed and the next initial_integrate() for particles of one thread, which follow those
  /// that it gave before.
  void move_ahead(int thread, Range particles);

  /// What forces do to velocities in half a step, and whose.
  [[nodiscard]] HalfKick half_kick() const;
  [[nodiscard]] Spheres spheres() const;

private:
  [[nodiscard]] int count() const;
  double move(int halves, Range particles) const;

  bool owed_ = false;
  struct alignas(64) Ahead {
    Range moved;
    double fastest = 0; // of them, squared speed
  };
  std::vector<Ahead> ahead_; // of each thread, since the last initial_integrate()
};

} // namespace granflux::particle_subset
