// SPDX-FileCopyrightText: 2026 The GranFlux developers
// SPDX-License-Identifier: GPL-2.0-or-later

#include "particle_groups.hpp"

#include <algorithm>

namespace granflux::driver {

namespace {

constexpr int all_bit = 1; // of the group `all` of both hosts

} // namespace

void ParticleGroups::show(std::span<const int> masks, coupling::ParticleView& view) {
  if (coupled_bit_ != all_bit) {
    coupled_.resize(masks.size());
    std::ranges::transform(masks, coupled_.begin(),
                           [&](int m) { return std::uint8_t((m & coupled_bit_) != 0); });
    view.coupled = coupled_;
  }
  if (frozen_bits_ || held_bit_ || !(moved_bits_ & all_bit)) {
    fixed_.resize(masks.size());
    std::ranges::transform(masks, fixed_.begin(), [&](int m) {
      return std::uint8_t((m & (frozen_bits_ | held_bit_)) != 0 || (m & moved_bits_) == 0);
    });
    view.fixed = fixed_;
  }
}

void ParticleGroups::clear_frozen_forces(std::span<const int> masks, std::span<Vec3> forces) const {
  if (!frozen_bits_)
    return;
  for (std::size_t i = 0; i < masks.size(); ++i)
    if (masks[i] & frozen_bits_)
      forces[i] = {};
}

} // namespace granflux::driver
