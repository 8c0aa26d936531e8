// SPDX-FileCopyrightText: 2026 The GranFlux developers
// SPDX-License-Identifier: BSD-3-Clause

// Every Nusselt law of the list is held to the contract of nusselt_law.hpp and to a table worked
// out from the papers (golden/nusselt.py). A law added to the list is red until the table has it.

#include <cmath>
#include <fstream>
#include <gtest/gtest.h>
#include <sstream>
#include <string>
#include <vector>

#include <granflux/coupling/nusselt/laws.hpp>

using namespace granflux::coupling;

namespace {

struct GoldenRow {
  NusseltInput in;
  double nu = 0;
};

std::vector<GoldenRow> golden(std::string_view law) {
  std::ifstream file(GRANFLUX_GOLDEN "/nusselt.csv");
  EXPECT_TRUE(file.is_open());
  std::vector<GoldenRow> rows;
  for (std::string line; std::getline(file, line);) {
    std::istringstream cells(line);
    std::string name, re, pr, eps, nu;
    std::getline(cells, name, ',');
    std::getline(cells, re, ',');
    std::getline(cells, pr, ',');
    std::getline(cells, eps, ',');
    std::getline(cells, nu);
    if (name == law)
      rows.push_back({{std::stod(re), std::stod(pr), std::stod(eps)}, std::stod(nu)});
  }
  return rows;
}

template <class F> std::size_t misses(const std::vector<GoldenRow>& rows, F&& law) {
  std::size_t missed = 0;
  for (const auto& row : rows)
    missed += !(std::abs(law(row.in) - row.nu) <= 1e-13 * row.nu);
  return missed;
}

TEST(NusseltLaws, MatchTheTable) {
  NusseltLaws::for_each([](auto law) {
    const auto rows = golden(law.name);
    EXPECT_GE(rows.size(), 12u) << law.name << " is not in golden/nusselt.csv";
    EXPECT_EQ(misses(rows, law), 0u) << law.name;
  });
}

TEST(NusseltLaws, TableCatchesFivePercent) {
  NusseltLaws::for_each([](auto law) {
    const auto rows = golden(law.name);
    EXPECT_EQ(misses(rows, [&](NusseltInput in) { return 1.05 * law(in); }), rows.size());
    // The flow's share alone, which vanishes without flow.
    const auto mutant = [&](NusseltInput in) {
      const double still = law({0, in.prandtl, in.void_fraction});
      return still + 1.05 * (law(in) - still);
    };
    EXPECT_EQ(misses(rows, mutant), rows.size() * 5 / 6) << law.name;
  });
}

// Published values, six digits, Pr = 0.7: Re = 0, 1, 10, 100, 1000.
TEST(NusseltLaws, PublishedValues) {
  const std::vector<std::pair<double, std::vector<double>>> gunn{
      {0.4, {3.8, 6.66083, 10.04417, 22.26700, 76.02323}},
      {0.5, {3.25, 5.65178, 8.36498, 17.91431, 59.35730}},
      {0.7, {2.45, 4.18408, 5.92252, 11.58314, 35.11596}},
      {0.9, {2.05, 3.45022, 4.70129, 8.41755, 22.99528}},
      {1.0, {2, 3.35849, 4.54863, 8.02185, 21.48020}}};
  const std::vector<double> reynolds{0, 1, 10, 100, 1000};
  for (const auto& [eps, values] : gunn)
    for (std::size_t i = 0; i < values.size(); ++i)
      EXPECT_NEAR(Gunn{}({reynolds[i], 0.7, eps}), values[i], 1e-5) << eps << " " << reynolds[i];
  const std::vector<double> sphere{2, 2.53274, 3.68468, 7.32742, 18.84679};
  for (std::size_t i = 0; i < sphere.size(); ++i)
    EXPECT_NEAR(RanzMarshall{}({reynolds[i], 0.7, 1}), sphere[i], 1e-5);
}

TEST(NusseltLaws, PositiveAndGrowingWithTheFlow) {
  NusseltLaws::for_each([](auto law) {
    const auto [low, high] = law.valid.void_fraction;
    for (int i = 0; i <= 10; ++i) {
      const double eps = low + (high - low) * i / 10;
      double last = 0;
      for (double re = 0; re <= law.valid.reynolds.high; re = re * 1.1 + 1) {
        const double nu = law({re, 0.7, eps});
        EXPECT_TRUE(std::isfinite(nu) && nu > 0.99 * last) << law.name << " Re " << re;
        last = nu;
      }
    }
  });
}

TEST(NusseltLaws, UnknownNameIsAnsweredWithTheKnown) {
  try {
    NusseltLaws::make("[coupling] nusselt", "gun");
    FAIL() << "accepted";
  } catch (const granflux::ConfigError& error) {
    const std::string text = error.what();
    for (const auto name : NusseltLaws::names)
      EXPECT_NE(text.find(name), text.npos) << name;
  }
}

} // namespace
