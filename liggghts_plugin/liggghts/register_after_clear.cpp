// SPDX-FileCopyrightText: 2026 The GranFlux developers
// SPDX-License-Identifier: GPL-2.0-or-later
//
// The script command `clear` makes a new Modify, with the stock styles only, and then calls
// LAMMPS::post_create. A definition in the program comes before that of a shared library (ELF
// symbol interposition), so the call arrives here: do the stock work, then register again.

#include <dlfcn.h>

#include <liggghts/lammps.h>

#include "register_styles.hpp"

[[gnu::visibility("default")]] void LAMMPS_NS::LAMMPS::post_create() {
  using PostCreate = void (*)(LAMMPS*);
  static const auto stock =
      reinterpret_cast<PostCreate>(dlsym(RTLD_NEXT, "_ZN9LAMMPS_NS6LAMMPS11post_createEv"));
  stock(this);
  granflux::liggghts::register_styles(*this);
}
