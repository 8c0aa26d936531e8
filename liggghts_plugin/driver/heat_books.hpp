// SPDX-FileCopyrightText: 2026 The GranFlux developers
// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

#include <cstdio>
#include <mpi.h>
#include <optional>

#include <granflux/coupling/compensated_sum.hpp>

namespace granflux::driver {

/// Powers that the particles of a rank receive in a step [W], in the order of the books.
struct HeatPowers {
  double conduction = 0;            ///< from other particles: sums to zero over all of them
  double walls = 0;                 ///< conducted from walls
  double friction = 0, damping = 0; ///< made in contacts
  double convection = 0;
  double source = 0;
  double to_walls = 0; ///< made in contacts and gone into walls, not into particles
  double held = 0;     ///< taken off those of fixed temperature
  double radiation = 0;
};

/// The energies that they have come to since the fix was made [J].
struct HeatBooks {
  coupling::CompensatedSum conduction, walls, friction, damping, convection, source, to_walls, held,
      radiation;

  void book(const HeatPowers& powers, double dt);
  HeatBooks& operator+=(const HeatBooks& o) &;
  [[nodiscard]] HeatPowers value() const; ///< J
};

/// Rank 0 gathers the books of all ranks and writes them as one block, its length first, as
/// hosts read it back. `heat_at_start`: of all particles when the books were opened [J]; empty:
/// they were not. Collective.
void write_heat_books(const HeatBooks& mine, std::optional<double> heat_at_start, std::FILE* file,
                      MPI_Comm comm);

/// This rank's books of a block that write_heat_books wrote, to the last bit; on another number of
/// ranks rank 0 continues the books of all. Throws ConfigError where the format is another.
HeatBooks read_heat_books(const char* block, std::optional<double>& heat_at_start, MPI_Comm comm);

} // namespace granflux::driver
