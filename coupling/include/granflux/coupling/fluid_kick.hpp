// SPDX-FileCopyrightText: 2026 The GranFlux developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cmath>

#include <granflux/cfd/vec3.hpp>

namespace granflux::coupling {

/// Response of a particle with linear drag over a time T, lambda = b T / m >= 0 (docs/
/// theory_coupling.md, section 3).
struct DragResponse {
  double mean = 1; ///< (1 - exp(-lambda)) / lambda: mean of exp(-b t/m) over the time [-]
  double lag = 0;  ///< mean - 1, to full relative precision however small lambda [-]
};

/// `lag` by its series: for lambda below small_lag_limit only, where it is as exact as expm1 and
/// cheaper.
[[nodiscard]] inline double small_lag(double lambda) {
  // (exp(x) - 1)/x - 1 = x/2! + x^2/3! + ... by Horner; products only, this is done every step.
  const double x = -lambda;
  return x *
         (1. / 2 +
          x * (1. / 6 + x * (1. / 24 + x * (1. / 120 +
                                            x * (1. / 720 + x * (1. / 5040 + x * (1. / 40320)))))));
}
inline constexpr double small_lag_limit = 0.05;

[[nodiscard]] inline DragResponse drag_response(double lambda) {
  if (lambda < small_lag_limit) {
    const double lag = small_lag(lambda);
    return {1 + lag, lag};
  }
  const double mean = -std::expm1(-lambda) / lambda; // no longer cancels
  return {mean, mean - 1};
}

/// Coefficient with which drag of coefficient b [kg/s] acts on the gas over an interval T [s]: the
/// mean drag on a free particle of mass m [kg] is this times its slip at the start [kg/s].
/// lambda = b T/m.
[[nodiscard]] inline double effective_coefficient(double b, double lambda) {
  return b * drag_response(lambda).mean;
}

/// Drag [N] whose impulse over `dt` takes a particle from `velocity` to the exact end of
/// m dv/dt = b (gas_velocity - v) + other, when `other` itself is applied as well.
/// lambda = b dt/m; 0 for a particle held in place, which gives the drag at its velocity.
[[nodiscard]] inline Vec3 exact_drag(double b, double lambda, const Vec3& gas_velocity,
                                     const Vec3& velocity, const Vec3& other) {
  const DragResponse r = drag_response(lambda);
  return b * r.mean * (gas_velocity - velocity) + r.lag * other;
}

} // namespace granflux::coupling
