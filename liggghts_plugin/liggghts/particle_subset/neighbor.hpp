// SPDX-FileCopyrightText: 2026 The GranFlux developers
// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

#include <liggghts/neighbor.h>

namespace granflux::particle_subset {

/// LIGGGHTS' neighbour lists, with the question whether they have aged asked on all threads, and
/// asked only when the fastest particles could have gone far enough.
class Neighbor : public LAMMPS_NS::Neighbor {
public:
  explicit Neighbor(LAMMPS_NS::LAMMPS* lammps);

  void init() override;
  void build(int topology) override;
  int check_distance() override;

  /// No particle has moved by more than `distance` [m] in this step.
  void moved_at_most(double distance) { travel_ += distance; }
  /// Whether moved_at_most() hears of every motion. If not, every check looks at the particles.
  void hears_all_motion(bool all);

private:
  [[nodiscard]] bool any_beyond_trigger() const;

  double travel_; // m, bound on the way of any particle since the lists were built
};

} // namespace granflux::particle_subset
