// SPDX-FileCopyrightText: 2026 The GranFlux developers
// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

#include <string>

#include <mpi.h>

#include "work_times.hpp"

namespace granflux::particle_subset {

/// What a rank had to do in a run.
struct WorkLoad {
  double steps = 0;
  double particles = 0; ///< mean over the steps
  double ghosts = 0;    ///< mean over the steps
  int threads = 1;
};

/// The table at the end of a run: parts, means over the ranks and the slowest rank, particles and
/// ghosts of ranks and threads. Collective; the same text on all ranks.
std::string work_report(const WorkTimes& times, const WorkLoad& load, MPI_Comm comm);

} // namespace granflux::particle_subset
