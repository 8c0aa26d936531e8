// SPDX-FileCopyrightText: 2026 The GranFlux developers
// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

#include <string>

#include "contact_time.hpp"

namespace granflux::driver {

/// Whether steps of temperature of `every` time steps of `dt` seconds see the contacts. Conduction
/// is taken once a step of temperature: over many collisions the mean is exact, but the heat of one
/// collision scatters by 10 % where it is seen twice and by 30 % where it is seen once
/// (docs/decisions/0028-temperatures-every-few-steps.md). Throws ConfigError where a collision may
/// pass unseen; returns a warning, or nothing, where it is seen less than twice. `speed`: of the
/// fastest particle [m/s]; 0: nothing collides.
[[nodiscard]] std::string check_heat_every(int every, double dt, const ContactTimes& times,
                                           double speed);

/// Throws ConfigError unless `couple_every`, time steps between two exchanges with the gas or 0
/// where their number changes, holds as many steps of temperature each time.
void check_heat_every_with_gas(int every, int couple_every);

} // namespace granflux::driver
