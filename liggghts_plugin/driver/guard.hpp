// SPDX-FileCopyrightText: 2026 The GranFlux developers
// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

#include <exception>
#include <string>

#include <fmt/core.h>

#include <granflux/cfd/error.hpp>

namespace granflux::driver {

/// Ends the run by the host's class Error: on all ranks alike, or by this one.
template <class Error> void end_run(Error& error, const std::string& text, bool all_alike) {
  const auto call = [&](const auto& words) {
    all_alike ? error.all(__FILE__, __LINE__, words) : error.one(__FILE__, __LINE__, words);
  };
  if constexpr (requires { error.all(__FILE__, __LINE__, text); })
    call(text); // LAMMPS: as characters it would be a pattern to fill in
  else
    call(text.c_str());
}

/// Runs what may throw for a fix of a host, and ends the run with the text where it does.
template <class Fix, class Error, class Work>
void guard(const Fix& fix, Error& error, Work&& work) {
  const auto text = [&](const std::exception& e) {
    return fmt::format("fix {} {}: {}", fix.id, fix.style, e.what());
  };
  try {
    work();
  } catch (const ConfigError& e) {
    end_run(error, text(e), true); // thrown on all ranks alike
  } catch (const NumericalError& e) {
    end_run(error, text(e), true); // likewise
  } catch (const std::exception& e) {
    end_run(error, text(e), false);
  }
}

} // namespace granflux::driver
