// SPDX-FileCopyrightText: 2026 The GranFlux developers
// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

namespace granflux::particle_subset {

/// The type of all `count` particles, or 0 if there are several or none.
[[nodiscard]] int common_type(const int* type, int count);

} // namespace granflux::particle_subset
