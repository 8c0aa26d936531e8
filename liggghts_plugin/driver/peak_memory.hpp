// SPDX-FileCopyrightText: 2026 The GranFlux developers
// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

#include <string>

#include <mpi.h>

namespace granflux::driver {

/// A line with the memory that the processes of `comm` have held at most: their sum and the largest
/// of one, code and libraries included. Collective.
std::string peak_memory(MPI_Comm comm);

} // namespace granflux::driver
