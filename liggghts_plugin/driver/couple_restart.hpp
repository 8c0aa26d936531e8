// SPDX-FileCopyrightText: 2026 The GranFlux developers
// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

#include <cstdio>
#include <mpi.h>
#include <optional>
#include <vector>

#include <granflux/coupling/coupler.hpp>

namespace granflux::driver {

/// What fix granflux/couple keeps in a restart file beside gas, books and the fluid states of the
/// particles. Equal on all ranks.
struct CoupleState {
  double time_step = 0;        ///< of the particles [s]
  double steps = 0;            ///< of the last coupling step
  double steps_left = 0;       ///< until the next coupling step
  double owed = 0;             ///< see CoupleClock [s]
  double next_fields_time = 0; ///< gas time of the next CGNS file [s]
  double fields_written = 0;   ///< CGNS files so far
};

/// What a restart file has brought, until the gas is made.
struct SavedCouple {
  CoupleState state;
  std::vector<char> record; ///< on rank 0; empty elsewhere
};

/// Hosts take no longer block from one fix: throws ConfigError on all ranks alike.
void check_block_fits(const coupling::Coupler& coupler);

/// Rank 0 writes the whole state as one block, its length first, as hosts read it back. Collective;
/// throws on all ranks alike: ConfigError where it is too long, NumericalError where it is not
/// finite. std::runtime_error, on rank 0, where the file takes no more.
void write_couple_state(const CoupleState& state, const coupling::Coupler& coupler, std::FILE* file,
                        MPI_Comm comm);
/// Of a gas that was not made since it was read, or, where there is nothing, not at all.
void write_couple_state(const std::optional<SavedCouple>& saved, std::FILE* file, MPI_Comm comm);

/// Takes such a block, which all ranks have; nothing where there was no gas. Throws ConfigError on
/// all ranks where it is damaged or foreign.
std::optional<SavedCouple> read_couple_state(const char* block, MPI_Comm comm);

/// On any number of ranks. Collective; throws as Coupler::load.
void load(const SavedCouple& saved, coupling::Coupler& coupler);

} // namespace granflux::driver
