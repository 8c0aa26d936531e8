// SPDX-FileCopyrightText: 2026 The GranFlux developers
// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include <granflux/coupling/particle_view.hpp>

namespace granflux::driver {

/// Which particles are coupled and which are held in place, by the groups of a host: every particle
/// has a mask with one bit a group.
class ParticleGroups {
public:
  /// coupled: the group of the fix. held: further particles held in place, or 0.
  ParticleGroups(int coupled, int held) : coupled_bit_(coupled), held_bit_(held) {}

  /// Held in place are: groups that a fix freezes, particles that no integrating fix moves, and the
  /// held group. The fixes may have changed between runs: to be said anew before each.
  void forget_fixes() { frozen_bits_ = moved_bits_ = 0; }
  void add_frozen(int bit) { frozen_bits_ |= bit; }
  void add_moved(int bit) { moved_bits_ |= bit; }

  /// Fills `coupled` and `fixed` of a view, which then borrows from this.
  void show(std::span<const int> masks, coupling::ParticleView& view);
  void clear_frozen_forces(std::span<const int> masks, std::span<Vec3> forces) const;

private:
  int coupled_bit_, held_bit_;
  int frozen_bits_ = 0, moved_bits_ = 0;
  std::vector<std::uint8_t> coupled_, fixed_;
};

} // namespace granflux::driver
