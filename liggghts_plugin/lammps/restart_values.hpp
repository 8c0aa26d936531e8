// SPDX-FileCopyrightText: 2026 The GranFlux developers
// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

#include "fmt_of_lammps.hpp"

#include <lammps/atom.h>

namespace granflux::lammps {

/// What pack_restart of a fix wrote for a particle behind its first number, which is the length of
/// the whole: it lies behind the values of `nth` other fixes.
[[nodiscard]] inline double* restart_values(const LAMMPS_NS::Atom& atom, int particle, int nth) {
  double* values = atom.extra[particle];
  for (int i = 0; i < nth; ++i)
    values += int(*values);
  return values + 1;
}

} // namespace granflux::lammps
