// SPDX-FileCopyrightText: 2026 The GranFlux developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include <granflux/cfd/gas_solver.hpp>

namespace granflux::cfd {

/// Writes the gas's whole state, and `run`, which is what the program itself has to remember (equal
/// on all ranks), to one file. It appears under its name only once it is whole and on the disk;
/// what was there before stays until then. Collective; throws NumericalError on all ranks where it
/// cannot be written or the state is not finite.
void write_checkpoint(const std::string& path, const GasSolver& gas,
                      const std::vector<double>& run);

/// Restores such a state and returns `run`: on any number of ranks, and so that the run continues
/// bit for bit on the same blocks. Collective; throws ConfigError on all ranks where the file is
/// missing, torn or foreign, or of another grid or other equations.
std::vector<double> read_checkpoint(const std::string& path, GasSolver& gas);

} // namespace granflux::cfd
