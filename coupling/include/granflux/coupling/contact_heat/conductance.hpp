// SPDX-FileCopyrightText: 2026 The GranFlux developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <numbers>

namespace granflux::coupling {

/// Conductance of the contact of two bodies through a circle of radius r_c much smaller than the
/// bodies [W/K]: 4 k_i k_j / (k_i + k_j) r_c, which is 2 k r_c for equal conductivities (Batchelor
/// and O'Brien, Proc. R. Soc. London A 355 (1977) 313-333). Conductivities k > 0 [W/(m K)], r_c
/// [m]. Symmetric to the last bit.
[[nodiscard]] inline double conductance_per_radius(double k_i, double k_j) {
  return 4 * k_i * k_j / (k_i + k_j);
}

/// Share of the heat made in a contact that goes into body i: the shares of two bodies add up to 1.
[[nodiscard]] inline double heat_share(double k_i, double k_j) {
  return k_i / (k_i + k_j);
}

/// Biot number of a sphere: resistance to conduction inside over that of its contacts, whose
/// conductances add up to `conductance` [W/K]: H / (pi k R). With one contact between equal
/// conductivities it is (2/pi) r_c/R, Eq. 15 of Amritkar, Deb, Tafti, J. Comput. Phys. 256 (2014).
[[nodiscard]] inline double biot_number(double conductance, double k, double radius) {
  return conductance / (std::numbers::pi * k * radius);
}

} // namespace granflux::coupling
