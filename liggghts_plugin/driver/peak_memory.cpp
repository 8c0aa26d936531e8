// SPDX-FileCopyrightText: 2026 The GranFlux developers
// SPDX-License-Identifier: GPL-2.0-or-later

#include "peak_memory.hpp"

#include <fmt/core.h>
#include <sys/resource.h>

namespace granflux::driver {

std::string peak_memory(MPI_Comm comm) {
  rusage used{};
  getrusage(RUSAGE_SELF, &used);
  const double mine = double(used.ru_maxrss) / 1024; // ru_maxrss is in KiB
  double sum = 0, most = 0;
  MPI_Allreduce(&mine, &sum, 1, MPI_DOUBLE, MPI_SUM, comm);
  MPI_Allreduce(&mine, &most, 1, MPI_DOUBLE, MPI_MAX, comm);
  int ranks = 1;
  MPI_Comm_size(comm, &ranks);
  if (ranks == 1)
    return fmt::format("granflux: peak memory {:.0f} MiB\n", most);
  return fmt::format("granflux: peak memory {:.0f} MiB on {} ranks, at most {:.0f} MiB on one\n",
                     sum, ranks, most);
}

} // namespace granflux::driver
