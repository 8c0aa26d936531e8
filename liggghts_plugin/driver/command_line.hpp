// SPDX-FileCopyrightText: 2026 The GranFlux developers
// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace granflux::driver {

/// Takes an option and its value out of a command line, so that the host sees the rest only; the
/// last one counts. Throws ConfigError where the value is missing.
std::optional<std::string_view> take_option(int& argc, char** argv, std::string_view option);

/// Sets the number of OpenMP threads: the value of `-threads`, which is taken out of the command
/// line, else OMP_NUM_THREADS, else 1 as in the hosts. Returns it. Throws ConfigError where it is
/// not a number of threads.
int take_threads(int& argc, char** argv);

/// What `-version` prints of a launcher: how it was built, and against which release of its host.
void print_version(std::string_view launcher, std::string_view host);

/// Instead of a start: the reason, told by rank 0, and the end of MPI.
void refuse_to_start(const std::string& reason);

} // namespace granflux::driver
