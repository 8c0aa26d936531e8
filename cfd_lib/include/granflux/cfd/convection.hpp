// SPDX-FileCopyrightText: 2026 The GranFlux developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

namespace granflux::cfd {

// A convection scheme gives the value of q on a face from the two cells on either side, as seen
// along the flow: far upwind, upwind, downwind. `w` is the downwind cell's share in linear
// interpolation. Schemes are values; the sweep over cells is templated on them.

/// Second order, no numerical diffusion; wiggles where a cell's Reynolds number is large.
struct Central {
  static constexpr bool looks_upwind = false; ///< whether the way of the flow matters
  double operator()(double, double up, double down, double w) const { return up + w * (down - up); }
};

/// Second-order upwind: continues the slope between the two upwind cells.
struct Upwind2 {
  static constexpr bool looks_upwind = true;
  double operator()(double far, double up, double, double) const { return up + 0.5 * (up - far); }
};

/// Total-variation diminishing, van Leer's harmonic limiter (J. Comput. Phys. 14 (1974) 361-370):
/// second order where q is smooth, upwind at extrema, never a new extremum.
struct Limited {
  static constexpr bool looks_upwind = true;
  double operator()(double far, double up, double down, double) const {
    const double behind = up - far, ahead = down - up;
    return behind * ahead > 0 ? up + behind * ahead / (behind + ahead) : up;
  }
};

} // namespace granflux::cfd
