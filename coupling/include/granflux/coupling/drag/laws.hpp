// SPDX-FileCopyrightText: 2026 The GranFlux developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <granflux/coupling/drag/beetstra.hpp>
#include <granflux/coupling/drag/di_felice.hpp>
#include <granflux/coupling/drag/ergun.hpp>
#include <granflux/coupling/drag/gidaspow.hpp>
#include <granflux/coupling/drag/gidaspow_blend.hpp>
#include <granflux/coupling/drag/koch_hill.hpp>
#include <granflux/coupling/drag/schiller_naumann.hpp>
#include <granflux/coupling/drag/stokes.hpp>
#include <granflux/coupling/drag/wen_yu.hpp>
#include <granflux/coupling/law_list.hpp>

namespace granflux::coupling {

template <DragLaw... Laws> using DragLawList = LawList<Laws...>;

/// All drag laws a case may name; a new one is one file and one word here.
using DragLaws = DragLawList<Stokes, SchillerNaumann, WenYu, Ergun, Gidaspow, GidaspowBlend,
                             DiFelice, KochHill, Beetstra>;
using AnyDragLaw = DragLaws::Any;

} // namespace granflux::coupling
