// SPDX-FileCopyrightText: 2026 The GranFlux developers
// SPDX-License-Identifier: BSD-3-Clause

// What is said where hypre is asked for and was not there when the library was built.

#include <gtest/gtest.h>

#include <granflux/cfd/error.hpp>

#include "pressure_problem.hpp"

namespace granflux::cfd {
namespace {

TEST(NoHypre, ErrorNamesThePackage) {
  const auto problem =
      testing::pressure_problem({4, 4, 4}, {1, 1, 1}, {false, false, false}, {1, 1, 1});
  try {
    make_pressure_solver(PressureMethod::hypre, problem.mesh, false, 1e-10);
    FAIL() << "no error";
  } catch (const ConfigError& error) {
    EXPECT_NE(std::string(error.what()).find("libhypre-dev"), std::string::npos);
  }
}

} // namespace
} // namespace granflux::cfd
