// SPDX-FileCopyrightText: 2026 The GranFlux developers
// SPDX-License-Identifier: GPL-2.0-or-later
//
// LIGGGHTS' headers include a list of this name, which its package does not install. Read several
// times with different macros, hence no include guard.

#include <liggghts/tangential_model_history.h>
#include <liggghts/tangential_model_luding_tn.h>
#include <liggghts/tangential_model_no_history.h>
