// SPDX-FileCopyrightText: 2026 The GranFlux developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <concepts>
#include <string_view>

#include <granflux/coupling/interval.hpp>

namespace granflux::coupling {

/// What a Nusselt law sees: three dimensionless numbers.
struct NusseltInput {
  double reynolds = 0;      ///< Re = rho eps |u - v| d / mu, with the superficial slip, as for drag
  double prandtl = 1;       ///< Pr = mu cp / k of the gas
  double void_fraction = 1; ///< eps, volume share of the gas
};

/// Where a law may be used. Laws do not clamp; the coupler counts the particles outside.
struct NusseltRange {
  Interval reynolds, void_fraction;
  [[nodiscard]] constexpr bool contains(const NusseltInput& in) const {
    return reynolds.contains(in.reynolds) && void_fraction.contains(in.void_fraction);
  }
};

/// The contract of all Nusselt laws. A law returns Nu = h d / k, with h the heat transfer
/// coefficient between a sphere of diameter d and gas of conductivity k, so that
///
///   heat to one particle  pi d^2 h (T_gas - T) = pi d k Nu (T_gas - T)   [W]
///
/// Nu is positive and finite at Re = 0 by its form.
template <class Law>
concept NusseltLaw = std::default_initializable<Law> && requires(const Law law, NusseltInput in) {
  { Law::name } -> std::convertible_to<std::string_view>;
  { Law::valid } -> std::convertible_to<NusseltRange>;
  { law(in) } -> std::same_as<double>;
};

} // namespace granflux::coupling
