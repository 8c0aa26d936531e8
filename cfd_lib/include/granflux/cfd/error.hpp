// SPDX-FileCopyrightText: 2026 The GranFlux developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <stdexcept>

namespace granflux {

/// The user's input is wrong. Thrown on every rank alike, before the first step. The text names
/// the file or command, the keyword, the value found and what is allowed.
struct ConfigError : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// The run cannot go on: no convergence, not-a-number, a void fraction out of range. Thrown on
/// every rank alike, after one reduction. The text names step, place and values.
struct NumericalError : std::runtime_error {
  using std::runtime_error::runtime_error;
};

} // namespace granflux
