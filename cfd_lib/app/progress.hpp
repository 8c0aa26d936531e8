// SPDX-FileCopyrightText: 2026 The GranFlux developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <chrono>
#include <string>

#include <fmt/format.h>

#include <granflux/cfd/gas_solver.hpp>

namespace granflux::cfd {

/// Seconds as a person says them: 12 s, 3 min 20 s, 2 h 05 min.
inline std::string spoken_duration(double seconds) {
  const auto s = (long long)(seconds + 0.5);
  if (s < 60)
    return fmt::format("{} s", s);
  if (s < 3600)
    return fmt::format("{} min {:02d} s", s / 60, s % 60);
  return fmt::format("{} h {:02d} min", s / 3600, s / 60 % 60);
}

/// Prints the course of a run: about twenty lines, and more where steps take long.
class Progress {
public:
  Progress(long steps, bool prints) : steps_(steps), prints_(prints) {
    if (prints_)
      fmt::print("{:>10} {:>12} {:>6} {:>9} {:>12} {:>9} {:>9}  {}\n", "step", "time [s]", "done",
                 "Courant", "continuity", "pressure", "viscous", "remaining");
  }

  /// After `step` of the steps. Continuity is the residual over its scale; pressure and viscous
  /// are iterations, 0 for a direct solve.
  void report(long step, double time, const StepReport& report) {
    if (!prints_ || !due(step))
      return;
    const double elapsed = seconds_since(start_);
    const double scale = report.continuity_scale > 0 ? report.continuity_scale : 1;
    fmt::print("{:>10} {:>12.6g} {:>5.1f}% {:>9.3g} {:>12.3e} {:>9} {:>9}  {}\n", step, time,
               100.0 * double(step) / double(steps_), report.courant,
               report.continuity_residual / scale, report.pressure_iterations,
               report.viscous_iterations,
               spoken_duration(elapsed / double(step) * double(steps_ - step)));
    std::fflush(stdout);
    last_line_ = Clock::now();
  }

private:
  using Clock = std::chrono::steady_clock;
  static constexpr long lines = 20;
  static constexpr double longest_silence = 30; // s

  static double seconds_since(Clock::time_point then) {
    return std::chrono::duration<double>(Clock::now() - then).count();
  }
  [[nodiscard]] bool due(long step) const {
    return step == 1 || step == steps_ || step * lines / steps_ != (step - 1) * lines / steps_ ||
           seconds_since(last_line_) > longest_silence;
  }

  long steps_;
  bool prints_;
  Clock::time_point start_ = Clock::now(), last_line_ = start_;
};

} // namespace granflux::cfd
