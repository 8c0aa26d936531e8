// SPDX-FileCopyrightText: 2026 The GranFlux developers
// SPDX-License-Identifier: BSD-3-Clause

// A program of somebody else: five steps of the gas of a case file, and a drag law.

#include <cstdio>
#include <exception>

#include <mpi.h>

#include <granflux/cfd/case_mesh.hpp>
#include <granflux/cfd/gas_solver.hpp>
#include <granflux/cfd/read_gas_case.hpp>
#include <granflux/coupling/drag/laws.hpp>

namespace {

void run(const char* case_file) {
  using namespace granflux;
  const cfd::GasCase gas_case = cfd::read_gas_case(case_file, MPI_COMM_WORLD);
  const cfd::Mesh mesh = cfd::make_mesh(gas_case, MPI_COMM_WORLD);
  const cfd::BlockFields void_fraction = cfd::make_fields(mesh, 1.0);
  cfd::GasSolver gas(mesh, gas_case);
  gas.initialise(void_fraction, gas_case.initial_velocity);
  for (int step = 0; step < 5; ++step)
    gas.advance(gas_case.numerics.time_step, void_fraction, nullptr);
  std::printf("flux out of top: %.6e m3/s\n", gas.boundary_flux("top"));

  const auto law = coupling::DragLaws::make("drag", "wen_yu");
  std::printf("wen_yu F(Re 0, eps 1): %.6f\n", std::visit(
                                                   [](const auto& f) {
                                                     return f({0, 1});
                                                   },
                                                   law));
}

} // namespace

int main(int argc, char** argv) {
  MPI_Init(&argc, &argv);
  int code = 0;
  try {
    run(argv[1]);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "consumer: %s\n", error.what());
    code = 1;
  }
  MPI_Finalize();
  return code;
}
