// SPDX-FileCopyrightText: 2026 The GranFlux developers
// SPDX-License-Identifier: BSD-3-Clause

// The checkpoint of granflux_cfd for the case that the corpus was written with.

#include <mpi.h>

#include <granflux/cfd/case_mesh.hpp>
#include <granflux/cfd/checkpoint.hpp>
#include <granflux/cfd/gas_solver.hpp>
#include <granflux/cfd/read_gas_case.hpp>

#include "fuzz_target.hpp"

const bool granflux::testing::places_and_processes = false;

void granflux::testing::read_input(const std::string&, const std::string& file) {
  using namespace granflux::cfd;
  const GasCase gas_case = read_gas_case(GRANFLUX_FUZZ_CASE, MPI_COMM_SELF);
  const Mesh mesh = make_mesh(gas_case, MPI_COMM_SELF);
  GasSolver gas(mesh, gas_case);
  gas.initialise(make_fields(mesh, 1.0), gas_case.initial_velocity);
  read_checkpoint(file, gas);
}
