// SPDX-FileCopyrightText: 2026 The GranFlux developers
// SPDX-License-Identifier: GPL-2.0-or-later
//
// LIGGGHTS' headers include a list of this name, which its package does not install. Read several
// times with different macros, hence no include guard.

#include <liggghts/normal_model_edinburgh.h>
#include <liggghts/normal_model_edinburgh_stiffness.h>
#include <liggghts/normal_model_hertz.h>
#include <liggghts/normal_model_hertz_stiffness.h>
#include <liggghts/normal_model_hooke.h>
#include <liggghts/normal_model_hooke_hysteresis.h>
#include <liggghts/normal_model_hooke_stiffness.h>
#include <liggghts/normal_model_luding.h>
#include <liggghts/normal_model_thornton_ning.h>
