// SPDX-FileCopyrightText: 2026 The GranFlux developers
// SPDX-License-Identifier: BSD-3-Clause

// The table of numbers and limits: what is close, what is beyond, what is said once, and which of
// several is the likely cause.
#include <gtest/gtest.h>

#include <cmath>

#include <granflux/cfd/stable_range.hpp>

using granflux::cfd::Bound;
using granflux::cfd::StableRange;
using granflux::cfd::Standing;

namespace {

Bound bound(const char* name, double limit, double advised, bool least = false) {
  return {.name = name, .limit = limit, .advised = advised, .least = least, .cure = [](double n) {
            return "half of " + std::to_string(int(n));
          }};
}

} // namespace

TEST(StableRange, StandingByLimitAndAdvice) {
  StableRange range;
  const std::size_t most = range.add(bound("speed", 10, 5)),
                    least = range.add(bound("gas", 0.05, 0.26, true)),
                    free = range.add(bound("friction", Bound::none, Bound::none));
  EXPECT_EQ(range.standing(most), Standing::unknown);
  for (const auto& [number, standing] :
       {std::pair{5., Standing::ok}, std::pair{5.1, Standing::close},
        std::pair{10., Standing::close}, std::pair{10.1, Standing::beyond},
        std::pair{std::nan(""), Standing::beyond}}) {
    range.set(most, number);
    EXPECT_EQ(range.standing(most), standing) << number;
  }
  for (const auto& [number, standing] :
       {std::pair{0.3, Standing::ok}, std::pair{0.2, Standing::close},
        std::pair{0.04, Standing::beyond}}) {
    range.set(least, number);
    EXPECT_EQ(range.standing(least), standing) << number;
  }
  range.set(free, 1e9);
  EXPECT_EQ(range.standing(free), Standing::no_limit);
  EXPECT_EQ(range.share(free), 0);
  range.forget(most, "no particles");
  EXPECT_EQ(range.standing(most), Standing::unknown);
  EXPECT_NE(range.table("stable range").find("no particles"), std::string::npos);
}

TEST(StableRange, WarnsOnceANumber) {
  StableRange range;
  const std::size_t row = range.add(bound("speed", 10, 5));
  range.set(row, 9);
  EXPECT_TRUE(range.new_warnings().empty());
  range.set(row, 12);
  EXPECT_EQ(range.new_warnings(),
            std::vector<std::string>{"speed is 12, its limit 10: half of 12"});
  range.set(row, 8);
  EXPECT_TRUE(range.new_warnings().empty());
  range.set(row, 20);
  EXPECT_TRUE(range.new_warnings().empty());
}

// What comes after is often the consequence.
TEST(StableRange, LikelyCauseIsWhatCameFirst) {
  StableRange range;
  const std::size_t a = range.add(bound("a", 1, 1)), b = range.add(bound("b", 1, 1)),
                    c = range.add(bound("c", 1, 1));
  EXPECT_EQ(range.likely_cause({a, b, c}), "");
  range.set(b, 3);
  range.set(c, 4);
  EXPECT_EQ(range.new_warnings().size(), 2U);
  range.set(a, 1000);
  range.set(c, 50);
  EXPECT_EQ(range.new_warnings().size(), 1U);
  EXPECT_EQ(range.likely_cause({a, b, c}), "c is 4, its limit 1: half of 4"); // of two the further
  range.set(c, 0.5);
  EXPECT_EQ(range.likely_cause({a, b, c}), "b is 3, its limit 1: half of 3");
  EXPECT_EQ(range.likely_cause({a}), "a is 1e+03, its limit 1: half of 1000");
}
