// SPDX-FileCopyrightText: 2026 The GranFlux developers
// SPDX-License-Identifier: BSD-3-Clause

// Conduction through the gas between spheres against quadrature, and the geometry of radiation.

#include <algorithm>
#include <cmath>
#include <gtest/gtest.h>
#include <numbers>
#include <utility>

#include <granflux/coupling/near_heat/gas_gap.hpp>
#include <granflux/coupling/near_heat/radiation.hpp>

using namespace granflux::coupling;

namespace {

constexpr double pi = std::numbers::pi;

/// Simpson's rule.
template <class F> double integral(F f, double from, double to, int pieces = 20000) {
  const double h = (to - from) / pieces;
  double sum = f(from) + f(to);
  for (int n = 1; n < pieces; ++n)
    sum += (n % 2 ? 4 : 2) * f(from + n * h);
  return sum * h / 3;
}

/// Circle in which two spheres cut each other; 0 where they do not.
double cut_radius(double a, double b, double distance) {
  const double height = (distance * distance + a * a - b * b) / (2 * distance);
  return std::sqrt(std::max(0.0, a * a - height * height));
}

/// 2 pi r k / max(gap(r), least) from the circle of overlap to the edge of the layer, on pieces
/// between which the integrand has no kink; r = R sin(angle) takes the roots away at the equator.
double by_quadrature(const GasGap& gap, double ri, double rj, double distance) {
  const double large = std::max(ri, rj), small = std::min(ri, rj);
  const double edge = (1 + gap.layer) * large;
  if (distance >= edge + small)
    return 0;
  const bool past_equator = distance * distance <= edge * edge - small * small;
  const double outer = past_equator ? small : cut_radius(edge, small, distance);
  const double inner = distance < ri + rj ? cut_radius(large, small, distance) : 0;
  // There the gap is the least one.
  double kink = inner;
  if (distance - gap.least_gap < ri + rj) {
    double low = inner, high = outer;
    for (int n = 0; n < 200; ++n) {
      const double r = 0.5 * (low + high);
      const double wide =
          distance - std::sqrt(large * large - r * r) - std::sqrt(small * small - r * r);
      (wide < gap.least_gap ? low : high) = r;
    }
    kink = low;
  }
  const auto along = [&](double angle) {
    const double r = small * std::sin(angle), height = small * std::cos(angle);
    const double wide = distance - std::sqrt(large * large - r * r) - height;
    return 2 * pi * gap.conductivity * r * height / std::max(wide, gap.least_gap);
  };
  const double middle = std::asin(kink / small), last = std::asin(std::min(1.0, outer / small));
  // From the kink on in steps that grow with the distance from it.
  const double fine = middle + 0.02 * (last - middle);
  return integral(along, std::asin(inner / small), middle) + integral(along, middle, fine) +
         integral(along, fine, last, 200000);
}

TEST(GasGap, IsTheIntegralOverTheGap) {
  for (const double layer : {0.1, 0.2, 0.5})
    for (const double rj : {1e-3, 0.9e-3, 0.5e-3, 0.1e-3})
      for (const double gap : {-5e-6, -1e-8, 0.0, 1e-8, 1e-6, 1e-5, 5e-5, 9e-5}) {
        const GasGap law{.conductivity = 0.026, .layer = layer, .least_gap = 1e-7};
        const double ri = 1e-3, distance = ri + rj + gap;
        const double expected = by_quadrature(law, ri, rj, distance);
        ASSERT_GT(expected, 0);
        EXPECT_NEAR(law.conductance(ri, rj, distance) / expected, 1, 2e-8)
            << layer << ' ' << rj << ' ' << gap;
        EXPECT_EQ(law.conductance(ri, rj, distance), law.conductance(rj, ri, distance));
      }
}

TEST(GasGap, OfEqualSpheresByHand) {
  // r dr = -u du with u^2 = R^2 - r^2, gap = D - 2u: pi k [-u - D/2 ln(D - 2u)] between the
  // heights.
  const GasGap law{.conductivity = 0.026};
  const double radius = 1e-3, distance = 2.01e-3, edge = 1.2e-3;
  const double u = (distance * distance + radius * radius - edge * edge) / (2 * distance);
  const double expected =
      pi * 0.026 *
      (u - radius + distance / 2 * std::log((distance - 2 * u) / (distance - 2 * radius)));
  EXPECT_NEAR(law.conductance(radius, radius, distance) / expected, 1, 1e-12);
}

TEST(GasGap, EndsAtItsReachWithoutAStep) {
  const GasGap law{.conductivity = 0.026};
  for (const double rj : {1e-3, 0.3e-3}) {
    const double end = 1e-3 + rj + law.reach(1e-3);
    EXPECT_EQ(law.conductance(1e-3, rj, end), 0);
    EXPECT_GT(law.conductance(1e-3, rj, end - 1e-7), 0);
    EXPECT_LT(law.conductance(1e-3, rj, end - 1e-9), 1e-4 * law.conductance(1e-3, rj, 1e-3 + rj));
  }
}

TEST(GasGap, GoesWithTheConductivity) {
  const GasGap air{.conductivity = 0.026}, other{.conductivity = 0.13};
  EXPECT_NEAR(other.conductance(1e-3, 1e-3, 2e-3) / air.conductance(1e-3, 1e-3, 2e-3), 5, 1e-14);
}

TEST(Radiation, VolumeThatBallsShare) {
  for (const auto& [a, b] : {std::pair(2.0, 1.0), std::pair(1.0, 1.0), std::pair(1.0, 3.0)}) {
    const double whole = 4. / 3 * pi * std::pow(std::min(a, b), 3);
    EXPECT_EQ(shared_volume(a, b, a + b), 0);
    EXPECT_NEAR(shared_volume(a, b, std::abs(a - b) * (1 - 1e-12)), whole, 1e-12 * whole);
    for (const double distance : {0.999 * (a + b), 0.8 * (a + b), 0.6 * (a + b)}) {
      // Discs across the line of the centres.
      const auto disc = [&](double x) {
        const double of_a = a * a - x * x, of_b = b * b - (x - distance) * (x - distance);
        return pi * std::max(0.0, std::min(of_a, of_b));
      };
      const double kink = (distance * distance + a * a - b * b) / (2 * distance);
      const double expected = integral(disc, std::max(-a, distance - b), kink) +
                              integral(disc, kink, std::min(a, distance + b));
      EXPECT_NEAR(shared_volume(a, b, distance) / expected, 1, 1e-7) << a << b << distance;
      EXPECT_NEAR(shared_volume(a, b, distance) / shared_volume(b, a, distance), 1, 1e-14);
    }
  }
}

TEST(Radiation, NoSphereIsSeenByMoreThanItsSurface) {
  // Closest packing: twelve neighbours, and six farther off by sqrt(2).
  const double radius = 1e-3, surface = 4 * pi * radius * radius;
  const double seen = 12 * facing_area(radius, radius, 2 * radius) +
                      6 * facing_area(radius, radius, 2 * std::sqrt(2.) * radius);
  EXPECT_GT(seen, 0.6 * surface);
  EXPECT_LT(seen, 0.74 * surface); // the share that spheres have of all space
  // Four large spheres around a small one, as tight as it goes.
  const double small = (std::sqrt(1.5) - 1) * radius;
  EXPECT_LT(4 * facing_area(small, radius, small + radius), 4 * pi * small * small);
  EXPECT_EQ(facing_area(small, radius, 1.1e-3), facing_area(radius, small, 1.1e-3));
  EXPECT_EQ(facing_area(radius, radius, 3 * radius), 0);
}

TEST(Radiation, Laws) {
  EXPECT_NEAR(difference_of_fourth_powers(400, 300), std::pow(400, 4) - std::pow(300, 4), 1e-3);
  EXPECT_DOUBLE_EQ(exchange_emissivity(1, 1), 1);
  EXPECT_DOUBLE_EQ(exchange_emissivity(1, 0.3), 0.3);
  EXPECT_NEAR(exchange_emissivity(0.5, 0.5), 1. / 3, 1e-15);
  // CODATA 2018: 2 pi^5 k^4 / (15 h^3 c^2).
  const double k = 1.380649e-23, h = 6.62607015e-34, c = 299792458;
  EXPECT_NEAR(stefan_boltzmann /
                  (2 * std::pow(pi, 5) * std::pow(k, 4) / (15 * std::pow(h, 3) * c * c)),
              1, 1e-9);
}

} // namespace
