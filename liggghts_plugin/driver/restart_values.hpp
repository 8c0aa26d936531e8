// SPDX-FileCopyrightText: 2026 The GranFlux developers
// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

namespace granflux::driver {

/// What pack_restart of a fix wrote for a particle behind its first number, which is the length of
/// the whole: it lies behind the values of `nth` other fixes. `extra`: the host's array of them.
[[nodiscard]] inline double* restart_values(double** extra, int particle, int nth) {
  double* values = extra[particle];
  for (int i = 0; i < nth; ++i)
    values += int(*values);
  return values + 1;
}

} // namespace granflux::driver
