// SPDX-FileCopyrightText: 2026 The GranFlux developers
// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

#include <cstdio>
#include <mpi.h>
#include <vector>

namespace granflux::driver {

/// What fix granflux/couple keeps in a restart file beside the fluid states of the particles.
struct CoupleState {
  double time_step = 0;        ///< of the particles [s]
  long steps_left = 0;         ///< until the next coupling step
  double owed = 0;             ///< see CoupleClock [s]
  double next_fields_time = 0; ///< gas time of the next CGNS file [s]
  long fields_written = 0;     ///< CGNS files so far
  std::vector<double> coupler; ///< Coupler::save of this rank
};

/// Rank 0 gathers the state of all ranks and writes it as one block, its length first, as
/// hosts read it back. Collective; throws ConfigError where it is too long for the format.
void write_couple_state(const CoupleState& state, std::FILE* file, MPI_Comm comm);

/// This rank's part of a block that write_couple_state wrote. Throws ConfigError where the number
/// of ranks differs.
CoupleState read_couple_state(const char* block, MPI_Comm comm);

} // namespace granflux::driver
