// SPDX-FileCopyrightText: 2026 The GranFlux developers
// SPDX-License-Identifier: BSD-3-Clause

// docs/howto/add_a_drag_law.md stays true: the law it prints, taken from the page by CMake, joins a
// list and is found by its name.

#include <gtest/gtest.h>

#include <granflux/coupling/drag/laws.hpp>
#include <my_law.hpp>

using namespace granflux::coupling;

TEST(Howto, PrintedDragLawWorks) {
  using Laws = DragLawList<Stokes, MyLaw>;
  const auto chosen = Laws::make("drag", "my_law");
  const double f = std::visit([](const auto& law) { return law({0, 1}); }, chosen);
  EXPECT_NEAR(f, 1, MyLaw::stokes_tolerance);
}
