// SPDX-FileCopyrightText: 2026 The GranFlux developers
// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

#include <string_view>
#include <utility>

#include "law/cohesion_off.hpp"
#include "law/cohesion_sjkr.hpp"
#include "law/rolling_cdt.hpp"
#include "law/rolling_epsd2.hpp"
#include "law/rolling_off.hpp"
#include "law/tangential_history.hpp"
#include "law/tangential_no_history.hpp"
#include "law/tangential_off.hpp"

namespace granflux::particle_subset {

template <class... Laws> struct Choices {};

// The laws that may go with any normal law.
using TangentialLaws = Choices<TangentialOff, TangentialHistory, TangentialNoHistory>;
using RollingLaws = Choices<RollingOff, RollingCdt, RollingEpsd2>;
using CohesionLaws = Choices<CohesionOff, CohesionSjkr>;

/// Calls make with the law of that name as an empty object; false if there is none.
template <class... Laws, class Make>
bool choose(Choices<Laws...>, std::string_view name, Make&& make) {
  return ((name == Laws::name && (make(Laws{}), true)) || ...);
}

} // namespace granflux::particle_subset
