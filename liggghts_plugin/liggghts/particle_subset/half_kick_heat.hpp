// SPDX-FileCopyrightText: 2026 The GranFlux developers
// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

#include "contact.hpp"
#include "kick.hpp"
#include "subset.hpp"

namespace granflux::particle_subset {

/// What a resistance makes of heat beyond what the velocities before the half kick of its step say
/// [W]. Forces are found with velocities half a step old; the work that velocity Verlet does in the
/// step is that of the force on the velocity at the step, and over all particles of contacts
/// -resistance . (velocity + half kick) is the exact loss of energy of motion. Called once all
/// forces are known. None for a particle that `half` does not move.
[[nodiscard]] double half_kick_heat(const HalfKick& half, const Spheres& spheres, int particle,
                                    const Resistance& resistance);

} // namespace granflux::particle_subset
