// SPDX-FileCopyrightText: 2026 The GranFlux developers
// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

#include <algorithm>
#include <cmath>

namespace granflux::driver {

/// When the gas is advanced and by how much. After a coupling step the gas is `every` particle
/// steps, or as many as keep_within() has left, ahead of the particles, which then catch up; the
/// count survives several runs, and a change of the time step between them.
class CoupleClock {
public:
  explicit CoupleClock(int every) : every_(every), steps_(every) {}

  /// Takes effect at the next coupling step.
  void set_every(int every) { every_ = steps_ = every; }
  /// The next coupling step has as many particle steps as `longest` seconds hold, one at least, and
  /// is little longer than the last: Adams and Bashforth's steps of the gas look back at it.
  void keep_within(double longest) {
    constexpr double fastest_growth = 1.1;
    const int most = std::min(every_, std::max(steps_ + 1, int(fastest_growth * steps_)));
    steps_ = longest < most * dt_ ? std::max(1, int(longest / dt_)) : most;
  }

  /// Before a run. The lead of the gas, in seconds, stays as it is; what is not a whole number of
  /// new steps is made up for in the next interval.
  void set_time_step(double dt) {
    if (dt == dt_)
      return;
    const double lead = double(steps_left_) * dt_ - owed_;
    dt_ = dt;
    steps_left_ = std::lround(lead / dt);
    owed_ = double(steps_left_) * dt - lead;
  }
  void count_step() { --steps_left_; }
  [[nodiscard]] bool due() const { return steps_left_ <= 0; }
  /// Particle steps a coupling step, at most.
  [[nodiscard]] int every() const { return every_; }
  /// Those of the last coupling step, or of the next.
  [[nodiscard]] int steps() const { return steps_; }
  /// Seconds by which the coupling step advances the gas.
  [[nodiscard]] double interval() const { return steps_ * dt_ + owed_; }
  void advanced() { steps_left_ = steps_, owed_ = 0; }

  [[nodiscard]] double time_step() const { return dt_; }
  [[nodiscard]] long steps_left() const { return steps_left_; }
  [[nodiscard]] double owed() const { return owed_; }
  void restore(double dt, int steps, long steps_left, double owed) {
    dt_ = dt, steps_ = steps, steps_left_ = steps_left, owed_ = owed;
  }

private:
  int every_, steps_;
  double dt_ = 0;       // of the particles [s]; 0 before the first run
  long steps_left_ = 0; // until the next coupling step
  double owed_ = 0;     // seconds to be added to the next interval
};

} // namespace granflux::driver
