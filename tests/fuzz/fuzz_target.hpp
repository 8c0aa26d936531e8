// SPDX-FileCopyrightText: 2026 The GranFlux developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

namespace granflux::testing {

/// Gives an input, which is also in `file`, to the reader under test. Throws ConfigError where the
/// reader refuses it.
void read_input(const std::string& input, const std::string& file);

/// A format in which everything has its place, read by libraries that keep what damaged files left
/// in them: inputs keep their length, and each has a process of its own.
extern const bool places_and_processes;

} // namespace granflux::testing
