// SPDX-FileCopyrightText: 2026 The GranFlux developers
// SPDX-License-Identifier: GPL-2.0-or-later

#include "force_team.hpp"

#include <algorithm>

#include <omp.h>

#include "work_times.hpp"

namespace granflux::particle_subset {

void ForceTeam::work_through(int thread, Range own, auto&& after) {
  for (const Part& part : parts_) {
    part.work->start_own_work(thread, own);
    after(part);
  }
  for_each_block(own, [&](Range block) {
    for (const Part& part : parts_) {
      part.work->own_work(thread, block);
      after(part);
    }
  });
}

bool ForceTeam::looks_back() const {
  return std::ranges::any_of(parts_, [](const Part& part) { return part.work->looks_back(); });
}

void ForceTeam::work(int owned, double& waiting) {
  if (parts_.empty())
    return;
  const Subset subset(owned, omp_get_max_threads());
  double done = MPI_Wtime();
  const auto time_since_last = [&done](const Part& part) {
    const double now = MPI_Wtime();
    *part.seconds += now - done;
    done = now;
  };
  const auto untimed = [](const Part&) {};
#pragma omp parallel num_threads(subset.threads())
  {
    const int thread = omp_get_thread_num();
    if (thread == 0)
      work_through(thread, subset.of(thread), time_since_last);
    else
      work_through(thread, subset.of(thread), untimed);
  }
  waiting += MPI_Wtime() - done;
  for (const Part& part : parts_) {
    const Lap lap(*part.seconds);
    part.work->end_own_work();
  }
  parts_.clear();
}

} // namespace granflux::particle_subset
