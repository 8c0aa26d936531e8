// SPDX-FileCopyrightText: 2026 The GranFlux developers
// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

#include <string>

#include <mpi.h>

namespace granflux::driver {

/// What the user should know of where the threads run: empty if all is well, else advice. A rank
/// that has fewer processors than threads is slower than with one thread (Open MPI binds a rank to
/// one core unless told otherwise). Collective; the same text on all ranks.
std::string thread_placement_advice(MPI_Comm comm);

} // namespace granflux::driver
