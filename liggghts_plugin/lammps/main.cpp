// SPDX-FileCopyrightText: 2026 The GranFlux developers
// SPDX-License-Identifier: GPL-2.0-or-later
//
// LAMMPS with the fixes of GranFlux: takes every option of `lmp` and the same scripts.

#include <csignal>
#include <cstdlib>
#include <string>
#include <string_view>

#include <fmt/core.h>
#include <mpi.h>

#include "fmt_of_lammps.hpp"

#include <lammps/comm.h>
#include <lammps/input.h>
#include <lammps/lammps.h>

#include <granflux/cfd/error.hpp>
#include <granflux/cfd/out_of_memory.hpp>

#include "driver/command_line.hpp"
#include "driver/peak_memory.hpp"
#include "driver/say.hpp"
#include "driver/thread_placement.hpp"

namespace {

/// LAMMPS looks at the environment for the number of threads, at its start and after `clear`.
void pass_on_threads(int threads) {
  setenv("OMP_NUM_THREADS", std::to_string(threads).c_str(), 1);
}

} // namespace

int main(int argc, char** argv) {
  if (argc == 2 && std::string_view(argv[1]) == "-version") {
    granflux::driver::print_version("granflux_lammps",
                                    fmt::format("LAMMPS {}", GRANFLUX_LAMMPS_RELEASE));
    return 0;
  }
  std::signal(SIGXFSZ, SIG_IGN); // a file that may not grow is an error of its write
  granflux::explain_out_of_memory();
  MPI_Init(&argc, &argv);
  try {
    pass_on_threads(granflux::driver::take_threads(argc, argv));
  } catch (const granflux::ConfigError& error) {
    granflux::driver::refuse_to_start(error.what());
    return 1;
  }
  {
    using granflux::driver::say;
    LAMMPS_NS::LAMMPS lammps(argc, argv, MPI_COMM_WORLD);
    say(lammps, granflux::driver::thread_placement_advice(lammps.world));
    lammps.input->file();
    say(lammps, fmt::format("\n{}", granflux::driver::peak_memory(lammps.world)));
  }
  MPI_Finalize();
}
