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

TEST(GasFlows, CylinderAtReynolds20) {
  const auto flow = [](double reynolds) {
    const CylinderGrid2D grid{
        .tangential = 48, .first = 0.06, .growth = 1.188, .wake = 2, .widest = 0.16, .gather = 0.7};
    return steady_cylinder(
        reynolds, grid,
        {.time_scheme = granflux::cfd::TimeScheme::implicit, .courant = 5, .change = 1e-4});
  };
  const CylinderFlow f = flow(20);
  constexpr double drag = 2.091, wake = 1.86; // published
  EXPECT_NEAR(f.drag, drag, 0.02 * drag);
  EXPECT_NEAR(f.wake_length, wake, 0.03 * wake);
  EXPECT_GT(flow(21).wake_length, 1.04 * wake); // as with 5 % of viscosity too little
}

} // namespace
