// SPDX-FileCopyrightText: 2026 The GranFlux developers
// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

#include "contact.hpp"

namespace granflux::particle_subset {

/// What a contact remembers by a law: zero where the law has none of it. `history`: of that
/// contact.
template <class Law> [[nodiscard]] Vec3 tangential_history(const double* history) {
  if constexpr (Law::has_tangential_history)
    return {history[0], history[1], history[2]};
  else
    return {};
}
template <class Law> [[nodiscard]] Vec3 rolling_history(const double* history) {
  if constexpr (Law::has_rolling_history) {
    const double* h = history + Law::rolling_offset;
    return {h[0], h[1], h[2]};
  } else {
    return {};
  }
}

} // namespace granflux::particle_subset
