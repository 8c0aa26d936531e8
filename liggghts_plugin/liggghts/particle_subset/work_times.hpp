// SPDX-FileCopyrightText: 2026 The GranFlux developers
// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

#include <mpi.h>

namespace granflux::particle_subset {

/// Seconds of this rank in one run, part by part.
struct WorkTimes {
  double contacts = 0;      ///< pair forces
  double contact_lists = 0; ///< of the pairs that may touch, where they are not LIGGGHTS' own
  double walls = 0;
  double integration = 0;
  double gas = 0; ///< with its exchange with the particles
  double other_fixes = 0;
  double neighbour_lists = 0; ///< check of their age, LIGGGHTS' own lists, memory of contacts
  double communication = 0;   ///< ghosts, exchange between ranks, sorting
  double output = 0;
  double waiting = 0; ///< of the first thread, for the others to finish their forces
  double total = 0;
};

/// Those of this process: the parts that are called by the host have no other way to add to them.
inline WorkTimes& work_times() {
  static WorkTimes times;
  return times;
}

/// Adds the time from its making to its end.
class Lap {
public:
  explicit Lap(double& seconds) : seconds_(seconds), start_(MPI_Wtime()) {}
  ~Lap() { seconds_ += MPI_Wtime() - start_; }
  Lap(const Lap&) = delete;
  Lap& operator=(const Lap&) = delete;

private:
  double& seconds_;
  double start_;
};

} // namespace granflux::particle_subset
