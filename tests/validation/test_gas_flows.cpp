// SPDX-FileCopyrightText: 2026 The GranFlux developers
// SPDX-License-Identifier: BSD-3-Clause

// The flows of run_gas on coarse grids. Errors are of second order, so what two grids extrapolate
// to is held to a share of them: 5 % of viscosity or buoyancy too much is seen.
#include <algorithm>
#include <cmath>
#include <fstream>
#include <gtest/gtest.h>
#include <sstream>

#include "gas_flows.hpp"

using namespace granflux::cfd::validation;

namespace {

struct Point {
  bool along_lid = true;
  double coordinate = 0, value = 0;
};

/// Points of an independent solution of the cavity inside of it; all lie at multiples of 1/128.
std::vector<Point> reference_points(int reynolds) {
  std::ifstream file(LID_REFERENCE);
  std::vector<Point> points;
  for (std::string line; std::getline(file, line);) {
    std::replace(line.begin(), line.end(), ',', ' ');
    std::istringstream words(line);
    std::string name;
    double coordinate = 0, as_printed = 0, value = 0;
    int of = 0;
    if (words >> name >> coordinate >> of >> as_printed >> value && of == reynolds &&
        coordinate > 0 && coordinate < 1)
      points.push_back({name == "U", std::round(coordinate * 128) / 128, value});
  }
  return points;
}

struct Errors {
  double coarse = 0, fine = 0, extrapolated = 0;
};

Errors lid_cavity_errors(double viscosity_factor) {
  const std::vector<Point> points = reference_points(100);
  EXPECT_EQ(points.size(), 30U);
  const auto run = [&](int cells) {
    return lid_cavity(100, {.cells = cells}, {.change = 1e-4}, viscosity_factor);
  };
  const LidCavity coarse = run(24), fine = run(48);
  Errors largest;
  for (const Point& p : points) {
    const double a = at(p.along_lid ? coarse.u : coarse.v, p.coordinate);
    const double b = at(p.along_lid ? fine.u : fine.v, p.coordinate);
    largest.coarse = std::max(largest.coarse, std::abs(a - p.value));
    largest.fine = std::max(largest.fine, std::abs(b - p.value));
    largest.extrapolated = std::max(largest.extrapolated, std::abs((4 * b - a) / 3 - p.value));
  }
  return largest;
}

TEST(GasFlows, LidCavityAtReynolds100) {
  const Errors e = lid_cavity_errors(1);
  EXPECT_LT(e.fine, 4e-3);
  EXPECT_GT(std::log2(e.coarse / e.fine), 1.8);
  EXPECT_LT(e.extrapolated, 1e-3);
  EXPECT_GT(lid_cavity_errors(1.05).extrapolated, 3e-3);
}

TEST(GasFlows, HeatedCavityAtRayleigh1e4) {
  const CavityGrid grid{.cells = 48, .stretching = 1};
  const HeatedCavity flow = heated_cavity(1e4, grid, {.change = 1e-4});
  constexpr double nusselt = 2.2448, u_max = 16.1833, v_max = 19.6292; // independent solution
  EXPECT_NEAR(flow.nusselt, nusselt, 0.005 * nusselt);
  EXPECT_NEAR(flow.nusselt_cold, flow.nusselt, 1e-3 * nusselt);
  EXPECT_NEAR(flow.u_max, u_max, 0.005 * u_max);
  EXPECT_NEAR(flow.v_max, v_max, 0.005 * v_max);
  EXPECT_GT(heated_cavity(1e4, grid, {.change = 1e-4}, 1.05).nusselt, 1.01 * nusselt);
}

} // namespace
