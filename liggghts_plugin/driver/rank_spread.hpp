// SPDX-FileCopyrightText: 2026 The GranFlux developers
// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

#include <array>
#include <cstddef>

#include <mpi.h>

namespace granflux::driver {

/// Least, mean and most of each number over the ranks. Collective.
template <std::size_t n> struct RankSpread {
  std::array<double, n> least, mean, most;

  RankSpread(const std::array<double, n>& mine, MPI_Comm comm) {
    int ranks = 1;
    MPI_Comm_size(comm, &ranks);
    MPI_Allreduce(mine.data(), least.data(), int(n), MPI_DOUBLE, MPI_MIN, comm);
    MPI_Allreduce(mine.data(), mean.data(), int(n), MPI_DOUBLE, MPI_SUM, comm);
    MPI_Allreduce(mine.data(), most.data(), int(n), MPI_DOUBLE, MPI_MAX, comm);
    for (double& value : mean)
      value /= ranks;
  }

  /// Imbalance: 0 where there is nothing.
  [[nodiscard]] double most_over_mean(std::size_t i) const {
    return mean[i] > 0 ? most[i] / mean[i] : 0;
  }
};

} // namespace granflux::driver
