// SPDX-FileCopyrightText: 2026 The GranFlux developers
// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

namespace granflux::driver {

/// While one lives, SIGTERM, SIGINT and SIGUSR2 (which mpirun hands on) ask for an end in order,
/// SIGUSR1 for a checkpoint; then what they did before is restored. A second signal that asks for
/// an end ends the process at once. Of this process: its runs share it.
class StopSignals {
public:
  StopSignals();
  ~StopSignals();
  StopSignals(const StopSignals&) = delete;
  StopSignals& operator=(const StopSignals&) = delete;

  enum class Wish { none, checkpoint, stop };
  /// Of this rank, since the start or the last answered().
  [[nodiscard]] static Wish wish();
  /// A checkpoint was written; a wish to stop stays.
  static void answered();
};

} // namespace granflux::driver
