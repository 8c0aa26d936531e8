// SPDX-FileCopyrightText: 2026 The GranFlux developers
// SPDX-License-Identifier: BSD-3-Clause

// A grid in a CGNS file, read and joined to a mesh.

#include <mpi.h>

#include <granflux/cfd/cgns_reader.hpp>

#include "fuzz_target.hpp"

const bool granflux::testing::places_and_processes = true;

void granflux::testing::read_input(const std::string&, const std::string& file) {
  const granflux::cfd::Grid grid =
      granflux::cfd::read_cgns_grid({.file = file, .base = "", .scale = {}}, MPI_COMM_SELF);
  granflux::cfd::make_mesh(grid, MPI_COMM_SELF);
}
