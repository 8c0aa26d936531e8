// SPDX-FileCopyrightText: 2026 The GranFlux developers
// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

// What LAMMPS' command `plugin load` and a module say to each other (LAMMPS manual, "Writing
// plugins"); the header that declares it is installed with no package.

namespace granflux::lammps {

extern "C" {
using StyleOfOneArgument = void*(void*);            // pair styles, commands
using StyleOfArguments = void*(void*, int, char**); // fixes, computes, regions
}

/// One style of a module.
struct PluginStyle {
  const char* version; ///< of LAMMPS that the module was compiled for: "29 Sep 2021"
  const char* style;   ///< "fix", "pair", ...
  const char* name;
  const char* info;
  const char* author;
  union {
    StyleOfOneArgument* of_one;
    StyleOfArguments* of_words;
  } creator;
  void* handle; ///< of the module, as its first function received it
};

/// What the module calls for each of its styles: style and LAMMPS.
using RegisterStyle = void (*)(PluginStyle*, void*);

} // namespace granflux::lammps
