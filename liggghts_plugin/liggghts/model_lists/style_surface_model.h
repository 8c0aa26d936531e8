// SPDX-FileCopyrightText: 2026 The GranFlux developers
// SPDX-License-Identifier: GPL-2.0-or-later
//
// LIGGGHTS' headers include a list of this name, which its package does not install. Read several
// times with different macros, hence no include guard.

#include <liggghts/surface_model_default.h>
#include <liggghts/surface_model_multicontact.h>
#include <liggghts/surface_model_superquadric.h>
