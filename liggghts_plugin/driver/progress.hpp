// SPDX-FileCopyrightText: 2026 The GranFlux developers
// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

#include <string>

namespace granflux::driver {

/// Lines on the progress of a run: share done, simulated time, speed, time left.
class Progress {
public:
  /// every: seconds of wall time between two lines; 0: none.
  explicit Progress(double every) : every_(every) {}
  void set_every(double every) { every_ = every; }

  /// `now`: wall time [s], as of MPI_Wtime.
  void start(long first_step, long last_step, double now);
  /// A line if it is time for one, else an empty text. `simulated`: of the gas [s].
  std::string line(long step, double simulated, double now);

private:
  double every_;
  long first_step_ = 0, last_step_ = 0;
  double start_ = 0, next_ = 0;
};

/// 3725 -> "1 h 02 min", 75 -> "1 min 15 s", 7.2 -> "7 s".
std::string duration(double seconds);

} // namespace granflux::driver
