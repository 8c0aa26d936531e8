// SPDX-FileCopyrightText: 2026 The GranFlux developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <gtest/gtest.h>
#include <string>

#include <granflux/cfd/error.hpp>

namespace granflux::test {

/// Text of the ConfigError that `action` must throw; a failure of the test if it does not.
template <class Action> std::string config_error(Action&& action) {
  try {
    action();
  } catch (const ConfigError& error) {
    return error.what();
  }
  ADD_FAILURE() << "no ConfigError was thrown";
  return {};
}

} // namespace granflux::test
