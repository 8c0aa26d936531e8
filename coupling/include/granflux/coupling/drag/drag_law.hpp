// SPDX-FileCopyrightText: 2026 The GranFlux developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <concepts>
#include <string_view>

#include <granflux/coupling/interval.hpp>

namespace granflux::coupling {

/// What a drag law sees: two dimensionless numbers.
struct DragInput {
  double reynolds = 0;      ///< Re = rho eps |u - v| d / mu, with the superficial slip
  double void_fraction = 1; ///< eps, volume share of the gas
};

/// Where a law may be used: its source's data and the limits its form was built to meet. Laws do
/// not clamp; the coupler counts the particles outside.
struct Range {
  Interval reynolds, void_fraction;
  [[nodiscard]] constexpr bool contains(const DragInput& in) const {
    return reynolds.contains(in.reynolds) && void_fraction.contains(in.void_fraction);
  }
};

/// The contract of all drag laws. A law returns F, the drag divided by Stokes drag at the
/// superficial slip, so that with slip = u - v (gas minus particle)
///
///   drag on one particle   3 pi mu d eps slip F                            [N]
///   per volume of mixture  beta slip,  beta = 18 mu eps (1 - eps) F / d^2  [N/m3]
///
/// Drag only: neither buoyancy nor the pressure gradient is in it (model A: both phases bear the
/// pressure gradient by volume). A source that reports the total force of a fixed bed, the mean
/// pressure gradient included, is to be multiplied by eps.
///
/// F is finite at Re = 0 by its form. A law whose range includes a void fraction of 1 states in
/// `stokes_tolerance` by how much F(0, 1) may differ from 1.
template <class Law>
concept DragLaw = std::default_initializable<Law> && requires(const Law law, DragInput in) {
  { Law::name } -> std::convertible_to<std::string_view>;
  { Law::valid } -> std::convertible_to<Range>;
  { law(in) } -> std::same_as<double>;
};

} // namespace granflux::coupling
