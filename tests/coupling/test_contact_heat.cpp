// SPDX-FileCopyrightText: 2026 The GranFlux developers
// SPDX-License-Identifier: BSD-3-Clause

// Conductance of a contact, against numbers worked out from Hertz's formulae by hand.

#include <cmath>
#include <gtest/gtest.h>
#include <numbers>

#include <granflux/coupling/contact_heat/conductance.hpp>
#include <granflux/coupling/contact_heat/contact_radius.hpp>

using namespace granflux::coupling;

namespace {

// Alumina: E 193.05 GPa, Poisson 0.3, k 36 W/(m K); equal spheres of 1 mm held by 1 mN.
constexpr double modulus = 193.05e9, poisson = 0.3, k = 36, radius = 1e-3, force = 1e-3;

double conductance(double r_c) {
  return conductance_per_radius(k, k) * r_c;
}

TEST(ContactHeat, TwoAluminaSpheres) {
  const double inverse = inverse_modulus(modulus, poisson, modulus, poisson);
  const ContactShape pair = shape_of_pair(radius, radius, 1e-9, force);
  EXPECT_NEAR(HertzRadius{}(inverse, pair), 1.5234e-6, 0.5e-10);
  EXPECT_NEAR(conductance(HertzRadius{}(inverse, pair)), 1.09684e-4, 0.5e-9);
  EXPECT_NEAR(conductance(GeometricRadius{}(inverse, pair)), 1.38193e-4, 0.5e-9);
}

// Two spheres pressed to Hertz's own overlap: radii from force and overlap are one, the circle of
// intersection is sqrt(2) wider, and the square root of its area sqrt(2 pi).
TEST(ContactHeat, DefinitionsRelateAsStated) {
  for (const auto& [ri, rj] : {std::pair(1e-3, 1e-3), std::pair(1e-3, 3e-3)}) {
    const double overlap = 1e-9, reduced = ri * rj / (ri + rj);
    const double inverse = inverse_modulus(modulus, poisson, 70e9, 0.2);
    const double hertz_force = std::sqrt(reduced) * std::pow(overlap, 1.5) / inverse;
    const ContactShape pair = shape_of_pair(ri, rj, overlap, hertz_force);
    const double r_c = OverlapRadius{}(inverse, pair);
    EXPECT_NEAR(HertzRadius{}(inverse, pair) / r_c, 1, 1e-12);
    EXPECT_NEAR(StockRadius{}(inverse, pair) / r_c, std::sqrt(2 * std::numbers::pi), 1e-5);
    EXPECT_NEAR(std::pow(GeometricRadius{}(inverse, pair) / r_c, 3), std::sqrt(ri * rj) / reduced,
                1e-10);
  }
}

TEST(ContactHeat, AWallIsASphereOfInfiniteRadius) {
  const double inverse = inverse_modulus(modulus, poisson, 70e9, 0.2);
  const ContactShape wall = shape_at_wall(radius, 1e-8, force);
  const ContactShape huge = shape_of_pair(radius, 1e9 * radius, 1e-8, force);
  EXPECT_NEAR(HertzRadius{}(inverse, huge) / HertzRadius{}(inverse, wall), 1, 1e-8);
  EXPECT_NEAR(OverlapRadius{}(inverse, huge) / OverlapRadius{}(inverse, wall), 1, 1e-8);
  EXPECT_NEAR(StockRadius{}(inverse, huge) / StockRadius{}(inverse, wall), 1, 1e-4);
}

TEST(ContactHeat, APullHasNoContactRadius) {
  const ContactShape pair = shape_of_pair(radius, radius, 1e-9, -force);
  EXPECT_EQ(HertzRadius{}(1e-11, pair), 0);
  EXPECT_EQ(GeometricRadius{}(1e-11, pair), 0);
}

TEST(ContactHeat, SharesAndConductances) {
  EXPECT_DOUBLE_EQ(conductance_per_radius(k, k), 2 * k);
  EXPECT_DOUBLE_EQ(conductance_per_radius(10, 30), 30);
  EXPECT_DOUBLE_EQ(heat_share(10, 30) + heat_share(30, 10), 1);
  EXPECT_DOUBLE_EQ(heat_share(10, 30), 0.25);
  // Eq. 15: (2/pi) r_c / R.
  EXPECT_NEAR(biot_number(2 * k * 1e-5, k, radius), 2 / std::numbers::pi * 0.01, 1e-15);
}

TEST(ContactHeat, CubeRootToTheLastDigits) {
  EXPECT_EQ(cube_root(0), 0);
  for (double x = 1e-300; x < 1e300; x *= 1.37)
    EXPECT_NEAR(cube_root(x) / std::cbrt(x), 1, 1e-15) << x;
  for (double x = 1; x < 8; x += 1e-4)
    EXPECT_NEAR(cube_root(x) / std::cbrt(x), 1, 1e-15) << x;
}

} // namespace
