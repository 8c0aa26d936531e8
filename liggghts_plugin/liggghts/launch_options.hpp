// SPDX-FileCopyrightText: 2026 The GranFlux developers
// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

namespace granflux::liggghts {

/// The command-line options that LIGGGHTS does not know.
struct LaunchOptions {
  bool subset = true; ///< particle work on threads in place of LIGGGHTS' own loops
};

/// Those of this process; the host's calls back into the plugin leave no other way to hand them on.
const LaunchOptions& launch_options();

/// Takes `-threads N` and `-subset on|off` out of the command line, so that LIGGGHTS sees the rest
/// only, and sets the number of OpenMP threads: N, else OMP_NUM_THREADS, else 1 as in LIGGGHTS.
/// Throws ConfigError if a value is missing or not allowed.
void take_launch_options(int& argc, char** argv);

} // namespace granflux::liggghts
