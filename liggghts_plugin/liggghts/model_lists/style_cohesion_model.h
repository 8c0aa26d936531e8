// SPDX-FileCopyrightText: 2026 The GranFlux developers
// SPDX-License-Identifier: GPL-2.0-or-later
//
// LIGGGHTS' headers include a list of this name, which its package does not install. Read several
// times with different macros, hence no include guard.

#include <liggghts/cohesion_model_easo_capillary_viscous.h>
#include <liggghts/cohesion_model_sjkr.h>
#include <liggghts/cohesion_model_sjkr2.h>
#include <liggghts/cohesion_model_washino_capillary_viscous.h>
