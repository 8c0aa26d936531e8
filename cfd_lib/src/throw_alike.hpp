// SPDX-FileCopyrightText: 2026 The GranFlux developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <mpi.h>
#include <string>

#include <granflux/cfd/error.hpp>

namespace granflux::cfd {

/// Throws Error on all ranks with what the first of them has to say; nothing where none has
/// an error. Collective.
template <class Error = ConfigError> void throw_alike(MPI_Comm comm, const std::string& error) {
  int rank = 0, ranks = 1;
  MPI_Comm_rank(comm, &rank);
  MPI_Comm_size(comm, &ranks);
  int first = error.empty() ? ranks : rank;
  MPI_Allreduce(MPI_IN_PLACE, &first, 1, MPI_INT, MPI_MIN, comm);
  if (first == ranks)
    return;
  int length = int(error.size());
  MPI_Bcast(&length, 1, MPI_INT, first, comm);
  std::string text = error;
  text.resize(std::size_t(length));
  MPI_Bcast(text.data(), length, MPI_CHAR, first, comm);
  throw Error(text);
}

} // namespace granflux::cfd
