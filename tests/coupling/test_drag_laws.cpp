// SPDX-FileCopyrightText: 2026 The GranFlux developers
// SPDX-License-Identifier: BSD-3-Clause

// Every drag law of the list is held to the contract of drag_law.hpp and to a table worked out
// from the papers (golden/drag.py). A law added to the list is tested by that alone, and red until
// the table has its rows.

#include <algorithm>
#include <cmath>
#include <fstream>
#include <gtest/gtest.h>
#include <set>
#include <sstream>
#include <string>
#include <vector>

#include <granflux/coupling/drag/laws.hpp>
#include <granflux/coupling/particle_block.hpp>

using namespace granflux::coupling;

namespace {

std::vector<double> void_fractions(const Range& valid) {
  std::vector<double> all;
  const auto [low, high] = valid.void_fraction;
  for (int i = 0; i <= 40; ++i)
    all.push_back(low + (high - low) * i / 40);
  return all;
}

/// 0, then 20 numbers a decade.
std::vector<double> reynolds_numbers(const Range& valid) {
  std::vector<double> all{0};
  for (double re = 1e-8; re < valid.reynolds.high; re *= std::pow(10, 0.05))
    all.push_back(re);
  all.push_back(valid.reynolds.high);
  return all;
}

struct GoldenRow {
  DragInput in;
  double f = 0;
};

std::vector<GoldenRow> golden(std::string_view law) {
  std::ifstream file(GRANFLUX_GOLDEN "/drag.csv");
  EXPECT_TRUE(file.is_open());
  std::vector<GoldenRow> rows;
  for (std::string line; std::getline(file, line);) {
    std::istringstream cells(line);
    std::string name, re, eps, f;
    std::getline(cells, name, ',');
    std::getline(cells, re, ',');
    std::getline(cells, eps, ',');
    std::getline(cells, f);
    if (name == law)
      rows.push_back({{std::stod(re), std::stod(eps)}, std::stod(f)});
  }
  return rows;
}

/// Rows of the table that a function of DragInput misses by more than round-off.
template <class F> std::vector<GoldenRow> misses(const std::vector<GoldenRow>& rows, F&& law) {
  std::vector<GoldenRow> missed;
  for (const auto& row : rows)
    if (!(std::abs(law(row.in) - row.f) <= 1e-12 * row.f))
      missed.push_back(row);
  return missed;
}

TEST(DragLaws, FiniteAndPositive) {
  DragLaws::for_each([](auto law) {
    for (const double eps : void_fractions(law.valid))
      for (const double re : reynolds_numbers(law.valid)) {
        const double f = law({re, eps});
        EXPECT_TRUE(std::isfinite(f) && f > 0) << law.name << " Re " << re << " eps " << eps;
      }
  });
}

// What a particle gets does not depend on its place in a block, nor on the others.
TEST(DragLaws, OnVectorRegistersAsAlone) {
  DragLaws::for_each([](auto law) {
    std::vector<DragInput> in;
    for (const double eps : void_fractions(law.valid))
      for (const double re : reynolds_numbers(law.valid))
        in.push_back({re, eps});
    const auto from = [&](std::size_t first) {
      return lanes([&](std::size_t i) { return law(in[(first + i) % in.size()]); });
    };
    for (std::size_t first = 0; first < in.size(); ++first) {
      const Lanes found = from(first), shifted = from(first + 1);
      for (std::size_t i = 0; i + 1 < particles_a_block; ++i)
        ASSERT_EQ(found[i + 1], shifted[i]) << law.name;
      ASSERT_NEAR(found[0], law(in[first]), 1e-14 * found[0]) << law.name;
    }
  });
}

// More slip never means less drag. (F itself may fall with Re: Di Felice in dense beds.)
TEST(DragLaws, ForceGrowsWithSlip) {
  DragLaws::for_each([](auto law) {
    for (const double eps : void_fractions(law.valid)) {
      double last = 0;
      for (const double re : reynolds_numbers(law.valid)) {
        const double force = re * law({re, eps});
        EXPECT_GE(force, last) << law.name << " Re " << re << " eps " << eps;
        last = force;
      }
    }
  });
}

TEST(DragLaws, SingleParticleLimit) {
  DragLaws::for_each([]<class Law>(Law law) {
    if constexpr (Law::valid.void_fraction.contains(1)) {
      EXPECT_NEAR(law({0, 1}), 1, Law::stokes_tolerance + 1e-15) << law.name;
    }
  });
}

TEST(DragLaws, ReachTheLimitOfZeroReynolds) {
  DragLaws::for_each([](auto law) {
    for (const double eps : void_fractions(law.valid))
      EXPECT_NEAR(law({1e-20, eps}), law({0, eps}), 1e-8 * law({0, eps})) << law.name;
  });
}

TEST(DragLaws, MatchTheTable) {
  DragLaws::for_each([](auto law) {
    const auto rows = golden(law.name);
    EXPECT_GE(rows.size(), 9u) << law.name << " is not in golden/drag.csv";
    for (const auto& row : misses(rows, law))
      ADD_FAILURE() << law.name << " Re " << row.in.reynolds << " eps " << row.in.void_fraction
                    << ": " << law(row.in) << ", table " << row.f;
  });
}

// The check above can fail: laws 5 % off are caught, by every row.
TEST(DragLaws, TableCatchesMutants) {
  DragLaws::for_each([](auto law) {
    const auto rows = golden(law.name);
    EXPECT_EQ(misses(rows, [&](DragInput in) { return 1.05 * law(in); }).size(), rows.size());
  });
  const auto ergun = golden("ergun");
  const auto mutant = [](DragInput in) {
    const double eps = in.void_fraction;
    return (1.05 * 150 * (1 - eps) + 1.75 * in.reynolds) / (18 * eps * eps);
  };
  EXPECT_EQ(misses(ergun, mutant).size(), ergun.size());
  const auto wen_yu = golden("wen_yu");
  const auto crowded = std::count_if(wen_yu.begin(), wen_yu.end(),
                                     [](const auto& row) { return row.in.void_fraction < 1; });
  const auto steeper = [](DragInput in) {
    return SchillerNaumann{}(in)*std::pow(in.void_fraction, -1.05 * 3.65);
  };
  EXPECT_EQ(misses(wen_yu, steeper).size(), std::size_t(crowded));
}

// What settles the normalisation of the simulated laws: creeping flow through dense arrays obeys
// Carman's law, in F 180 phi / (18 eps^2) = 10 phi / eps^2, for both.
TEST(DragLaws, SimulatedLawsMeetCarman) {
  for (const double phi : {0.5, 0.55, 0.6}) {
    const double eps = 1 - phi, carman = 10 * phi / (eps * eps);
    EXPECT_NEAR(KochHill{}({0, eps}), carman, 1e-12 * carman);
    EXPECT_NEAR(Beetstra{}({0, eps}), carman, 0.03 * carman);
  }
}

// The exact expansion for dilute random arrays (Kim and Russel 1985), total force: F0 =
// 1 + 3 sqrt(phi/2) + 135/64 phi ln phi + 16.456 phi. It tells the fit's 17.14 from 16.14.
TEST(DragLaws, KochHillMeetsTheDiluteExpansion) {
  const double phi = 1e-7;
  const double f0 = KochHill{}({0, 1 - phi}) / (1 - phi);
  const double linear = (f0 - 1 - 3 * std::sqrt(phi / 2) - 135. / 64 * phi * std::log(phi)) / phi;
  EXPECT_NEAR(linear, 16.456, 0.02);
}

// Two groups' simulations of the same arrays.
TEST(DragLaws, SimulatedLawsAgree) {
  for (const double phi : {0.1, 0.2, 0.3, 0.39, 0.5})
    EXPECT_NEAR(KochHill{}({0, 1 - phi}) / Beetstra{}({0, 1 - phi}), 1, 0.1) << phi;
}

TEST(DragLaws, GidaspowSwitchesAtFourFifths) {
  const double below = std::nextafter(0.8, 0);
  EXPECT_EQ(Gidaspow{}({50, below}), Ergun{}({50, below}));
  EXPECT_EQ(Gidaspow{}({50, 0.8}), WenYu{}({50, 0.8}));
  EXPECT_DOUBLE_EQ(GidaspowBlend{}({50, 0.8}), 0.5 * (Ergun{}({50, 0.8}) + WenYu{}({50, 0.8})));
}

TEST(DragLaws, ChosenByName) {
  const std::set<std::string_view> names(DragLaws::names.begin(), DragLaws::names.end());
  EXPECT_EQ(names.size(), DragLaws::names.size()) << "two laws have one name";
  for (const auto name : DragLaws::names) {
    const AnyDragLaw chosen = DragLaws::make("drag", name);
    EXPECT_EQ(std::visit([](const auto& law) { return std::string_view(law.name); }, chosen), name);
  }
}

TEST(DragLaws, UnknownNameIsAnsweredWithTheKnown) {
  try {
    DragLaws::make("[coupling] drag", "gidaspo");
    FAIL() << "accepted";
  } catch (const granflux::ConfigError& error) {
    const std::string text = error.what();
    EXPECT_NE(text.find("[coupling] drag"), text.npos);
    EXPECT_NE(text.find("'gidaspo'"), text.npos);
    for (const auto name : DragLaws::names)
      EXPECT_NE(text.find(name), text.npos) << name;
  }
}

} // namespace
