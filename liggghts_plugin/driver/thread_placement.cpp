// SPDX-FileCopyrightText: 2026 The GranFlux developers
// SPDX-License-Identifier: GPL-2.0-or-later

#include "thread_placement.hpp"

#include <sched.h>

#include <array>

#include <fmt/core.h>
#include <omp.h>

namespace granflux::driver {

namespace {

int allowed_processors() {
  cpu_set_t set;
  CPU_ZERO(&set);
  return sched_getaffinity(0, sizeof(set), &set) == 0 ? CPU_COUNT(&set) : omp_get_num_procs();
}

} // namespace

std::string thread_placement_advice(MPI_Comm comm) {
  const int threads = omp_get_max_threads();
  std::array<int, 2> few{allowed_processors(), omp_get_num_places()};
  MPI_Allreduce(MPI_IN_PLACE, few.data(), int(few.size()), MPI_INT, MPI_MIN, comm);
  const auto [processors, places] = few;
  if (threads == 1)
    return {};
  if (processors < threads)
    return fmt::format(
        "granflux: {} threads a rank, but a rank may use {} processor{} only. Give it more: "
        "'mpirun "
        "--bind-to none' or '--map-by slot:PE={}' with Open MPI, or fewer threads.\n",
        threads, processors, processors == 1 ? "" : "s", threads);
  if (places == 0)
    return fmt::format("granflux: {} threads a rank are free to wander between processors. To pin "
                       "them: OMP_PLACES=cores OMP_PROC_BIND=close\n",
                       threads);
  return {};
}

} // namespace granflux::driver
