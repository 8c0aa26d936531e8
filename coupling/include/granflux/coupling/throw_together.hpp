// SPDX-FileCopyrightText: 2026 The GranFlux developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <mpi.h>
#include <string>

namespace granflux::coupling {

/// Throws Error on every rank alike where any rank has a complaint, with the text of the lowest
/// such rank; an empty text is none. One small reduction when all is well. Collective.
template <class Error> void throw_together(MPI_Comm comm, std::string complaint) {
  int rank = 0, ranks = 0;
  MPI_Comm_rank(comm, &rank);
  MPI_Comm_size(comm, &ranks);
  int speaker = complaint.empty() ? ranks : rank;
  MPI_Allreduce(MPI_IN_PLACE, &speaker, 1, MPI_INT, MPI_MIN, comm);
  if (speaker == ranks)
    return;
  int length = int(complaint.size());
  MPI_Bcast(&length, 1, MPI_INT, speaker, comm);
  complaint.resize(std::size_t(length));
  MPI_Bcast(complaint.data(), length, MPI_CHAR, speaker, comm);
  throw Error(complaint);
}

} // namespace granflux::coupling
