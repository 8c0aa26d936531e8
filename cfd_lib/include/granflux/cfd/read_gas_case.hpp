// SPDX-FileCopyrightText: 2026 The GranFlux developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <mpi.h>
#include <string>

#include <granflux/cfd/case_file.hpp>
#include <granflux/cfd/gas_case.hpp>

namespace granflux::cfd {

/// Takes the tables of the gas from a case file (docs/reference/case_file.md): grid, fluid,
/// boundary, initial, numerics, output. Other tables are left to their readers; call
/// CaseFile::finish when all have read.
GasCase read_gas_case(CaseFile& file);

/// The gas case of a file for a run of the gas alone: the [coupling] table is skipped, all else
/// has to be known. Collective.
GasCase read_gas_case(const std::string& path, MPI_Comm comm);

} // namespace granflux::cfd
