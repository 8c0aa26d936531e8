// SPDX-FileCopyrightText: 2026 The GranFlux developers
// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

#include <optional>

#include "particle_rows.hpp"

namespace granflux::driver {

/// Force and torque of each particle in the last step before a checkpoint. Hosts compute forces
/// anew where a run starts, with velocities of another half step: with these in their place it goes
/// on to the last bit. Restart files always have the room; rows exist between reading and the first
/// set-up only.
class KeptForces {
public:
  /// Room for n particles, before they are read.
  void expect(int n);

  /// Numbers of a particle in a restart file, the first of which is this length.
  static constexpr int saved = 8;
  /// Force and torque may be null: there is nothing to keep.
  static int pack(const double* force, const double* torque, double* buffer);

  /// Rows of the particles, as they come and go; null where none are kept.
  [[nodiscard]] ParticleRows* rows() { return rows_ ? &*rows_ : nullptr; }
  /// Puts them into the host's arrays of n particles; those that came later keep what they have.
  void restore(double** force, double** torque, int n);
  void drop() { rows_.reset(); }

private:
  std::optional<ParticleRows> rows_;
};

} // namespace granflux::driver
