// SPDX-FileCopyrightText: 2026 The GranFlux developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <cmath>
#include <numbers>

#include <granflux/coupling/drag/drag_law.hpp>
#include <granflux/coupling/power.hpp>

namespace granflux::coupling {

/// Lattice-Boltzmann simulations of random arrays: Hill, Koch and Ladd, J. Fluid Mech. 448 (2001)
/// 213-278; Koch and Hill, Annu. Rev. Fluid Mech. 33 (2001) 619-647; in the form used for
/// fluidised beds, the linear law for every Re (van Buijtenen et al., Chem. Eng. Sci. 66 (2011)
/// 2368-2376): with phi = 1 - eps
///   beta = 18 mu eps^2 phi / d^2 (F0 + F3 Re / 2) .
/// The half: their Re has the radius. They divide the whole force of the fixed bed by Stokes drag,
/// the mean pressure gradient included, hence one more eps: F = eps (F0 + F3 Re / 2). (At high phi
/// eps F0 = 10 phi / eps^2, which is Carman's 180 phi / (18 eps^2), the same normalisation as the
/// 150 in Ergun.)
///
/// F0 below phi = 0.4 is Koch and Sangani's fit (J. Fluid Mech. 400 (1999) 229-263). Its 17.14 is
/// what the exact dilute expansion 1 + 3 sqrt(phi/2) + 135/64 phi ln phi + 16.456 phi (Kim and
/// Russel, J. Fluid Mech. 154 (1985) 269-286) asks for: 17.14 - 0.681 = 16.46; the 16.14 found in
/// some papers and codes misses it. F0 jumps down by 4 % at phi = 0.4.
struct KochHill {
  static constexpr std::string_view name = "koch_hill";
  static constexpr Range valid{.reynolds = {0, 200}, .void_fraction = {0.36, 1}};
  static constexpr double stokes_tolerance = 0;

  double operator()(DragInput in) const {
    const double eps = in.void_fraction, phi = 1 - eps;
    const double f0 = phi < 0.4 ? dilute(phi) : 10 * phi / (eps * eps * eps);
    const double f3 = 0.0673 + 0.212 * phi + 0.0232 / (eps * eps * eps * eps * eps);
    return eps * (f0 + 0.5 * f3 * in.reynolds);
  }

private:
  static double dilute(double phi) {
    const double phi_ln_phi =
        phi * std::numbers::ln2 * logarithm2(std::max(phi, 1e-300)); // 0 at phi = 0
    return (1 + 3 * std::sqrt(phi / 2) + 135. / 64 * phi_ln_phi + 17.14 * phi) /
           (1 + phi * (0.681 + phi * (-8.48 + phi * 8.16)));
  }
};

} // namespace granflux::coupling
