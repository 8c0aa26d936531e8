// SPDX-FileCopyrightText: 2026 The GranFlux developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <mpi.h>
#include <string>
#include <unistd.h>

namespace granflux::test {

inline int rank_here() {
  int rank = 0;
  MPI_Comm_rank(MPI_COMM_WORLD, &rank);
  return rank;
}

/// A folder of this program alone, the same on all ranks; gone at the end. Both are for all ranks.
class RankFolder {
public:
  RankFolder() {
    int id = int(getpid());
    MPI_Bcast(&id, 1, MPI_INT, 0, MPI_COMM_WORLD);
    path = std::filesystem::temp_directory_path() / ("granflux_test_" + std::to_string(id));
    if (rank_here() == 0)
      std::filesystem::create_directory(path);
    MPI_Barrier(MPI_COMM_WORLD);
  }
  ~RankFolder() {
    MPI_Barrier(MPI_COMM_WORLD);
    if (rank_here() == 0)
      std::filesystem::remove_all(path);
  }
  RankFolder(const RankFolder&) = delete;
  RankFolder& operator=(const RankFolder&) = delete;
  std::filesystem::path path;
};

} // namespace granflux::test
