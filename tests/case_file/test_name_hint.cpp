// SPDX-FileCopyrightText: 2026 The GranFlux developers
// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <granflux/cfd/nearest_name.hpp>

using granflux::edit_distance;
using granflux::name_hint;

TEST(EditDistance, CountsLettersInsertedDeletedAndReplaced) {
  EXPECT_EQ(edit_distance("", ""), 0u);
  EXPECT_EQ(edit_distance("", "abc"), 3u);
  EXPECT_EQ(edit_distance("abc", ""), 3u);
  EXPECT_EQ(edit_distance("kitten", "sitting"), 3u);
  EXPECT_EQ(edit_distance("densty", "density"), 1u);
  EXPECT_EQ(edit_distance("viscosity", "viscosity"), 0u);
}

TEST(NameHint, OffersTheNearestName) {
  EXPECT_EQ(name_hint("densty", {"viscosity", "density"}), "did you mean density?");
}

TEST(NameHint, ListsAllWhereNoneIsNear) {
  EXPECT_EQ(name_hint("colour", {"viscosity", "density"}), "known are: viscosity, density");
  EXPECT_EQ(name_hint("colour", {}), "none is known here");
}
