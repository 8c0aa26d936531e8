// SPDX-FileCopyrightText: 2026 The GranFlux developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <cmath>

#include <granflux/cfd/gas_case.hpp>

namespace granflux::cfd {

/// Steps of a run of the gas alone: equal ones, or as long as the Courant number allows.
class TimeSteps {
public:
  explicit TimeSteps(const Numerics& numerics)
      : numerics_(numerics), equal_(numerics.end_time / double(count())) {}

  /// Of equal steps, none longer than asked.
  [[nodiscard]] long count() const {
    return long(std::ceil(numerics_.end_time / numerics_.time_step * (1 - 1e-12)));
  }

  /// `rate`: Courant number per time of the flow as it is [1/s].
  double next(double time, double rate) {
    if (numerics_.courant == 0)
      return equal_;
    constexpr double fastest_growth = 1.1; // Adams-Bashforth looks back one step
    double step = numerics_.time_step;
    if (rate > 0)
      step = std::min(step, numerics_.courant / rate);
    if (last_ > 0)
      step = std::min(step, fastest_growth * last_);
    const double left = numerics_.end_time - time;
    if (left < 10 * step) // arrive at the end without a tiny last step
      step = left / std::ceil(left / step * (1 - 1e-12));
    return last_ = step;
  }
  [[nodiscard]] bool at_end(double time) const {
    return time > (numerics_.courant == 0 ? numerics_.end_time - 0.5 * equal_
                                          : numerics_.end_time * (1 - 1e-12));
  }
  [[nodiscard]] double last() const { return last_; }
  void continue_from(double last) { last_ = last; }

private:
  Numerics numerics_;
  double equal_;
  double last_ = 0; ///< 0: none yet
};

} // namespace granflux::cfd
