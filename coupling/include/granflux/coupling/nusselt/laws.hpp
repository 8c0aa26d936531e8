// SPDX-FileCopyrightText: 2026 The GranFlux developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <granflux/coupling/law_list.hpp>
#include <granflux/coupling/nusselt/gunn.hpp>
#include <granflux/coupling/nusselt/li_mason.hpp>
#include <granflux/coupling/nusselt/ranz_marshall.hpp>
#include <granflux/coupling/nusselt/wakao.hpp>

namespace granflux::coupling {

template <NusseltLaw... Laws> using NusseltLawList = LawList<Laws...>;

/// All Nusselt laws a case may name; a new one is one file and one word here.
using NusseltLaws = NusseltLawList<Gunn, RanzMarshall, Wakao, LiMason>;
using AnyNusseltLaw = NusseltLaws::Any;

} // namespace granflux::coupling
