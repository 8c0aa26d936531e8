// SPDX-FileCopyrightText: 2026 The GranFlux developers
// SPDX-License-Identifier: GPL-2.0-or-later
//
// LIGGGHTS' headers include a list of this name, which its package does not install. Read several
// times with different macros, hence no include guard.

#include <liggghts/rolling_model_cdt.h>
#include <liggghts/rolling_model_epsd.h>
#include <liggghts/rolling_model_epsd2.h>
#include <liggghts/rolling_model_epsd3.h>
#include <liggghts/rolling_model_luding.h>
