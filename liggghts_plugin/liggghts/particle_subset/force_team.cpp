// SPDX-FileCopyrightText: 2026 The GranFlux developers
// SPDX-License-Identifier: GPL-2.0-or-later

#include "force_team.hpp"

#include <omp.h>

#include "work_times.hpp"

namespace granflux::particle_subset {

void ForceTeam::work(int owned, double& waiting) {
  if (parts_.empty())
    return;
  const Subset subset(owned, omp_get_max_threads());
  double done = 0;
#pragma omp parallel num_threads(subset.threads())
  {
    const int thread = omp_get_thread_num();
    if (thread == 0) {
      for (const Part& part : parts_) {
        const Lap lap(*part.seconds);
        part.work->own_work(thread, subset.of(thread));
      }
      done = MPI_Wtime();
    } else {
      for (const Part& part : parts_)
        part.work->own_work(thread, subset.of(thread));
    }
  }
  waiting += MPI_Wtime() - done;
  for (const Part& part : parts_) {
    const Lap lap(*part.seconds);
    part.work->end_own_work();
  }
  parts_.clear();
}

} // namespace granflux::particle_subset
