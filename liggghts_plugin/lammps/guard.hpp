// SPDX-FileCopyrightText: 2026 The GranFlux developers
// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

#include <exception>

#include <fmt/core.h>

#include "fmt_of_lammps.hpp"

#include <lammps/error.h>
#include <lammps/fix.h>

#include <granflux/cfd/error.hpp>

namespace granflux::lammps {

/// Runs what may throw for a fix, and stops LAMMPS with the text where it does.
template <class Work> void guard(const LAMMPS_NS::Fix& fix, LAMMPS_NS::Error& error, Work&& work) {
  const auto text = [&](const std::exception& e) {
    return fmt::format("fix {} {}: {}", fix.id, fix.style, e.what());
  };
  try {
    work();
  } catch (const ConfigError& e) {
    error.all(FLERR, text(e)); // thrown on all ranks alike
  } catch (const NumericalError& e) {
    error.all(FLERR, text(e)); // likewise
  } catch (const std::exception& e) {
    error.one(FLERR, text(e));
  }
}

} // namespace granflux::lammps
