// SPDX-FileCopyrightText: 2026 The GranFlux developers
// SPDX-License-Identifier: BSD-3-Clause

#include <cmath>
#include <limits>
#include <random>

#include <gtest/gtest.h>

#include <granflux/coupling/power.hpp>

namespace granflux::coupling {
namespace {

constexpr double infinite = std::numeric_limits<double>::infinity();

TEST(Power, MatchesTheLibrarysInMoreDigits) {
  std::mt19937 random(1);
  std::uniform_real_distribution<double> digits(-14, 14), exponent(-4, 4);
  for (int n = 0; n < 200000; ++n) {
    const double x = std::pow(10, digits(random)), y = exponent(random);
    const long double wanted = std::pow((long double)x, (long double)y);
    if (wanted > 1e14L || wanted < 1e-14L)
      continue;
    ASSERT_NEAR(double(power(x, y) / wanted - 1), 0, 1e-14) << x << "^" << y;
  }
  for (const double y : {-3.65, 0.2, 0.687, 0.7, 1.})
    EXPECT_NEAR(power(1, y), 1, 2e-16);
}

TEST(Power, LogarithmToTheLastDigits) {
  std::mt19937 random(2);
  std::uniform_real_distribution<double> digits(-300, 300), near(-1, 1);
  const auto expect = [](double x) {
    const long double wanted = std::log2((long double)x);
    ASSERT_NEAR(logarithm2(x), double(wanted), 5e-16 * double(std::abs(wanted))) << x;
  };
  for (int n = 0; n < 100000; ++n) {
    expect(std::pow(10, digits(random)));
    expect(1 + std::pow(10, near(random) - 1.5));
    expect(1 - 0.3 * std::abs(near(random)));
  }
  for (int e = -1000; e <= 1000; ++e)
    EXPECT_EQ(logarithm2(std::ldexp(1., e)), e);
}

TEST(Power, ExponentialToTheLastDigits) {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> any(-1020, 1020), small(-2, 2);
  const auto expect = [](double x) {
    ASSERT_NEAR(double(exponential2(x) / std::exp2((long double)x) - 1), 0, 5e-16) << x;
  };
  for (int n = 0; n < 100000; ++n) {
    expect(any(random));
    expect(small(random));
  }
  for (int k = -1020; k <= 1020; ++k)
    EXPECT_EQ(exponential2(k), std::ldexp(1., k));
}

TEST(Power, BeyondNumbers) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(logarithm2(0), -infinite);
  EXPECT_EQ(logarithm2(infinite), infinite);
  EXPECT_TRUE(std::isnan(logarithm2(-1)));
  EXPECT_TRUE(std::isnan(logarithm2(nan)));
  EXPECT_EQ(exponential2(-infinite), 0);
  EXPECT_EQ(exponential2(-2000), 0);
  EXPECT_EQ(exponential2(2000), infinite);
  EXPECT_EQ(exponential2(infinite), infinite);
  EXPECT_TRUE(std::isnan(exponential2(nan)));
  EXPECT_EQ(power(0, 0.687), 0);
  EXPECT_EQ(power(0, -3.65), infinite);
  EXPECT_EQ(power(infinite, 0.5), infinite);
  EXPECT_TRUE(std::isnan(power(-1, 0.5)));
  EXPECT_TRUE(std::isnan(power(nan, 0.5)));
}

} // namespace
} // namespace granflux::coupling
