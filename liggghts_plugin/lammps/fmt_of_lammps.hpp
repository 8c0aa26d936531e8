// SPDX-FileCopyrightText: 2026 The GranFlux developers
// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

// To be included before any header of LAMMPS.

#include <fmt/format.h>

namespace fmt {

/// LAMMPS' headers were written for fmt 7 and name this function of it, which fmt 9 no longer has,
/// in templates that format a message. Deleted: texts are formatted before LAMMPS gets them, as its
/// library was built with an fmt of its own.
template <typename... Arguments> void make_args_checked(const Arguments&...) = delete;

} // namespace fmt
