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
  /// `start`, `end`: simulated time of the run [s].
  Progress(double start, double end, bool prints) : start_(start), end_(end), prints_(prints) {
    if (prints_)
      fmt::print("{:>10} {:>12} {:>6} {:>9} {:>12} {:>9} {:>9}  {}\n", "step", "time [s]", "done",
                 "Courant", "continuity", "pressure", "viscous", "remaining");
  }

  /// After a step. Continuity is the residual over its scale; pressure and viscous are iterations,
  /// 0 for a direct solve.
  void report(long step, double time, const StepReport& report) {
    const double done = (time - start_) / (end_ - start_);
    if (!prints_ || !due(done, time >= end_))
      return;
    const double scale = report.continuity_scale > 0 ? report.continuity_scale : 1;
    fmt::print("{:>10} {:>12.6g} {:>5.1f}% {:>9.3g} {:>12.3e} {:>9} {:>9}  {}\n", step, time,
               100 * done, report.courant, report.continuity_residual / scale,
               report.pressure_iterations, report.viscous_iterations,
               spoken_duration(seconds_since(started_) * (1 - done) / done));
    std::fflush(stdout);
    last_line_ = Clock::now();
    printed_ = done;
  }

private:
  using Clock = std::chrono::steady_clock;
  static constexpr double lines = 20;
  static constexpr double longest_silence = 30; // s

  static double seconds_since(Clock::time_point then) {
    return std::chrono::duration<double>(Clock::now() - then).count();
  }
  [[nodiscard]] bool due(double done, bool last) const {
    return printed_ < 0 || last || int(done * lines) != int(printed_ * lines) ||
           seconds_since(last_line_) > longest_silence;
  }

  double start_, end_;
  bool prints_;
  double printed_ = -1; ///< share that was done when the last line was printed; none yet: -1
  Clock::time_point started_ = Clock::now(), last_line_ = started_;
};

} // namespace granflux::cfd
