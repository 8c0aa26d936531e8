// SPDX-FileCopyrightText: 2026 The GranFlux developers
// SPDX-License-Identifier: BSD-3-Clause

// docs/howto/add_a_drag_law.md stays true: the law and the list of laws that it prints, put by
// CMake before those of the library, make a law that a case file can name.

#include <gtest/gtest.h>

#include <granflux/cfd/error.hpp>
#include <granflux/coupling/drag/laws.hpp>
#include <granflux/coupling/read_coupling.hpp>

using namespace granflux;
using namespace granflux::coupling;

TEST(Howto, PrintedDragLawWorks) {
  const auto chosen = DragLaws::make("drag", "my_law");
  const double f = std::visit([](const auto& law) { return law({0, 1}); }, chosen);
  EXPECT_NEAR(f, 1, MyLaw::stokes_tolerance);
}

TEST(Howto, CaseFileMayNameIt) {
  auto file = cfd::CaseFile::parse("[coupling]\ndrag = \"my_law\"\n", "case.toml");
  EXPECT_EQ(read_coupling(file).drag, "my_law");
  auto other = cfd::CaseFile::parse("[coupling]\ndrag = \"my_lax\"\n", "case.toml");
  EXPECT_THROW(read_coupling(other), ConfigError);
}
