// SPDX-FileCopyrightText: 2026 The GranFlux developers
// SPDX-License-Identifier: GPL-2.0-or-later
//
// LIGGGHTS with the styles of GranFlux: takes every option of `liggghts` and the same scripts.

#include <csignal>
#include <cstdio>
#include <string>
#include <string_view>

#include <fmt/core.h>
#include <mpi.h>

#include <liggghts/lammps.h>

#include <liggghts/comm.h>
#include <liggghts/error.h>
#include <liggghts/input.h>
#include <liggghts/signal_handling.h>
#include <liggghts/universe.h>

#include <granflux/cfd/error.hpp>
#include <granflux/cfd/out_of_memory.hpp>

#include "driver/command_line.hpp"
#include "driver/peak_memory.hpp"
#include "driver/say.hpp"
#include "driver/thread_placement.hpp"
#include "launch_options.hpp"
#include "register_styles.hpp"

namespace {

constexpr std::string_view host_version = GRANFLUX_HOST_VERSION;

/// The plugin derives from classes of the library, whose layout belongs to one build of it.
void check_host(LAMMPS_NS::LAMMPS& lammps) {
  const std::string_view found = lammps.universe->version;
  if (found.find(host_version) == std::string_view::npos)
    lammps.error->all(FLERR, fmt::format("granflux was compiled against '{}', but the library "
                                         "says '{}': build granflux again",
                                         host_version, found)
                                 .c_str());
}

/// Ctrl-C, SIGTERM and SIGUSR1 do what they do in the stock program, end the run in order, unless a
/// fix granflux/checkpoint takes them.
void install_signal_handlers() {
  std::signal(SIGXFSZ, SIG_IGN); // a file that may not grow is an error of its write
  std::signal(SIGINT, LAMMPS_NS::SignalHandler::int_handler);
  std::signal(SIGTERM, LAMMPS_NS::SignalHandler::int_handler);
  std::signal(SIGUSR1, LAMMPS_NS::SignalHandler::usr1_handler);
}

} // namespace

int main(int argc, char** argv) {
  if (argc == 2 && std::string_view(argv[1]) == "-version") {
    granflux::driver::print_version("granflux", host_version);
    return 0;
  }
  install_signal_handlers();
  // An error of one rank ends the program without flushing: its message must be out line by line.
  std::setvbuf(stdout, nullptr, _IOLBF, BUFSIZ);
  granflux::explain_out_of_memory();
  MPI_Init(&argc, &argv);
  try {
    granflux::liggghts::take_launch_options(argc, argv);
  } catch (const granflux::ConfigError& error) {
    granflux::driver::refuse_to_start(error.what());
    return 1;
  }
  {
    using granflux::driver::say;
    LAMMPS_NS::LAMMPS lammps(argc, argv, MPI_COMM_WORLD);
    check_host(lammps);
    say(lammps, granflux::driver::thread_placement_advice(lammps.world));
    granflux::liggghts::register_styles(lammps);
    lammps.input->file();
    say(lammps, fmt::format("\n{}", granflux::driver::peak_memory(lammps.world)));
  }
  MPI_Finalize();
}
