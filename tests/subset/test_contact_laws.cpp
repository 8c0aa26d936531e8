// SPDX-FileCopyrightText: 2026 The GranFlux developers
// SPDX-License-Identifier: BSD-3-Clause

#include <algorithm>
#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include <particle_subset/fifth_root.hpp>

#include "spheres.hpp"

namespace granflux::particle_subset::test {
namespace {

constexpr double pi = std::numbers::pi;

TEST(FifthRoot, IsThatOfTheStandardLibrary) {
  // 0.2 is not a fifth: in double precision std::pow is off where the logarithm is large.
  for (double x = 1e-300; x < 1e300; x *= 1.37)
    EXPECT_NEAR(fifth_root(x) / double(std::pow((long double)(x), 0.2L)), 1, 5e-16) << x;
}

/// Two spheres that meet; velocity Verlet until they have parted.
struct Impact {
  Spheres spheres;
  double largest_overlap = 0, largest_force = 0, duration = 0;

  void run(const LawNames& names, const Material& material, double dt) {
    Contacts contacts(names, material, 1, 1);
    Spheres& s = spheres;
    contacts.build(s, 0.5 * s.radius[0]);
    bool met = false;
    for (int step = 0; step < 1000000; ++step) {
      contacts.forces(s, dt);
      const double overlap = s.radius[0] + s.radius[1] - norm(s.position[0] - s.position[1]);
      met |= overlap > 0;
      if (met && overlap <= 0)
        return;
      duration += overlap > 0 ? dt : 0;
      largest_overlap = std::max(largest_overlap, overlap);
      largest_force = std::max(largest_force, norm(s.force[0]));
      for (std::size_t p = 0; p < 2; ++p) {
        s.velocity[p] += dt / s.mass[p] * s.force[p];
        s.spin[p] += dt / (0.4 * s.mass[p] * s.radius[p] * s.radius[p]) * s.torque[p];
        s.position[p] += dt * s.velocity[p];
      }
    }
    ADD_FAILURE() << "the spheres did not part";
  }
};

Impact head_on(double radius, double speed, double density) {
  Impact impact;
  impact.spheres.add({0, 0, 0}, {speed, 0, 0}, {}, radius, density);
  impact.spheres.add({2 * radius, 0, 0}, {-speed, 0, 0}, {}, radius, density);
  return impact;
}

// Hertz: d_max = (5 m v^2 / (4 K))^(2/5), K = (4/3) E* sqrt(R*), contact time 2.943275 d_max / v;
// the cases and numbers of Chung and Ooi, Granular Matter 13 (2011) 643-656.
TEST(Hertz, ImpactOfTwoSpheres) {
  struct Case {
    double modulus, poisson, density, overlap, force, time;
  };
  for (const Case& c : {Case{48e9, 0.20, 2800, 274.113e-6, 10.6969e3, 40.339e-6},
                        Case{20e9, 0.25, 2500, 368.304e-6, 7.1082e3, 54.201e-6}}) {
    Impact impact = head_on(10e-3, 10, c.density);
    TestMaterial material;
    material.values = {
        {"Yeff", c.modulus / (2 * (1 - c.poisson * c.poisson))}, {"Geff", 1}, {"betaeff", 0}};
    impact.run({.normal = "hertz"}, material, 1e-9);
    EXPECT_NEAR(impact.largest_overlap / c.overlap, 1, 1e-4);
    EXPECT_NEAR(impact.largest_force / c.force, 1, 1e-4);
    EXPECT_NEAR(impact.duration / c.time, 1, 1e-3);
    EXPECT_NEAR(impact.spheres.velocity[0].x, -10, 1e-2);
  }
}

// Damping from restitution e: gamma = 2 m |ln e| / t_c; t_c = pi / sqrt(k/m - (gamma/2m)^2),
// parting where the overlap vanishes.
TEST(HookeStiffness, RestitutionAndDuration) {
  const double radius = 2e-3, density = 2500, k = 1e4, e = 0.8;
  Impact impact = head_on(radius, 0.5, density);
  const double mass = impact.spheres.mass[0] / 2;
  const double beta = -std::log(e) / std::sqrt(pi * pi + std::log(e) * std::log(e));
  TestMaterial material;
  material.values = {
      {"k_n", k}, {"k_t", 1}, {"gamman_abs", 2 * beta * std::sqrt(k * mass)}, {"gammat_abs", 0}};
  material.options = {{"absolute_damping", true}};
  impact.run({.normal = "hooke/stiffness"}, material, 1e-8);
  EXPECT_NEAR(impact.spheres.velocity[0].x, -e * 0.5, 1e-4);
  EXPECT_NEAR(impact.duration, pi / std::sqrt(k / mass * (1 - beta * beta)), 2e-8);
}

// The stiffness is that of the Hertz contact at the speed V: the overlap V sqrt(m/k) of the linear
// spring; restitution as asked for.
TEST(Hooke, StiffnessOfTheCharacteristicVelocity) {
  const double radius = 3e-3, density = 1500, yeff = 4e6, speed = 0.7, e = 0.6;
  Impact impact = head_on(radius, speed / 2, density);
  const double mass = impact.spheres.mass[0] / 2, reduced = radius / 2;
  const double k = 16. / 15 * std::sqrt(reduced) * yeff *
                   std::pow(15 * mass * speed * speed / (16 * std::sqrt(reduced) * yeff), 0.2);
  TestMaterial material;
  material.values = {{"Yeff", yeff}, {"charVel", speed}, {"coeffRestLog", std::log(e)}};
  impact.run({.normal = "hooke"}, material, 1e-7);
  const double beta = -std::log(e) / std::sqrt(pi * pi + std::log(e) * std::log(e));
  EXPECT_NEAR(impact.duration, pi / std::sqrt(k / mass * (1 - beta * beta)), 2e-7);
  EXPECT_NEAR(impact.spheres.velocity[0].x, -e * speed / 2, 1e-4);
}

// A flat hit slides all the time: the tangential impulse is mu (1 + e) times the normal one, and
// turns both spheres by 5/2 of it over the radius.
TEST(TangentialHistory, SlidingImpact) {
  const double radius = 2.5e-3, mu = 0.092, vn = 1, vt = 2;
  Impact impact = head_on(radius, vn, 4000);
  impact.spheres.velocity[0].y = vt;
  impact.spheres.velocity[1].y = -vt;
  TestMaterial material;
  material.values = {
      {"k_n", 1e9}, {"k_t", 8e8}, {"gamman_abs", 0}, {"gammat_abs", 0}, {"coeffFrict", mu}};
  material.options = {{"absolute_damping", true}};
  impact.run({.normal = "hooke/stiffness", .tangential = "history"}, material, 2e-11);
  const Spheres& s = impact.spheres;
  // The normal turns a little while they touch: not exact.
  EXPECT_NEAR(vt - s.velocity[0].y, mu * 2 * vn, 0.01 * mu * 2 * vn);
  EXPECT_NEAR(s.spin[0].z * radius, -2.5 * mu * 2 * vn, 0.01 * 2.5 * mu * 2 * vn);
  EXPECT_NEAR(s.spin[0].z, s.spin[1].z, 1e-9 * std::abs(s.spin[0].z));
}

/// Two overlapping spheres of different size; one evaluation.
struct Press {
  Spheres s;
  double r1 = 2e-3, r2 = 3e-3, overlap = 1e-4;
  Press() {
    s.add({0, 0, 0}, {0, 0, 0}, {0, 0, 0}, r1, 2000);
    s.add({r1 + r2 - overlap, 0, 0}, {0, 0, 0}, {0, 0, 0}, r2, 2000);
  }
  void evaluate(const LawNames& names, const Material& material, double dt, int times = 1) {
    Contacts contacts(names, material, 1, 1);
    contacts.build(s, 0);
    for (int n = 0; n < times; ++n)
      contacts.forces(s, dt);
  }
};

TestMaterial linear(double kn, double kt) {
  TestMaterial material;
  material.values = {{"k_n", kn},           {"k_t", kt},         {"gamman_abs", 0},
                     {"gammat_abs", 0.5},   {"coeffFrict", 0.3}, {"coeffRollFrict", 0.2},
                     {"cohEnergyDens", 5e4}};
  material.options = {{"absolute_damping", true}, {"tangential_damping", true}};
  return material;
}

TEST(CohesionSjkr, PullsByTheCircleOfIntersection) {
  Press press;
  const double d = press.r1 + press.r2 - press.overlap;
  const double offset = (d * d + press.r1 * press.r1 - press.r2 * press.r2) / (2 * d);
  const double area = pi * (press.r1 * press.r1 - offset * offset);
  press.evaluate({.normal = "hooke/stiffness", .cohesion = "sjkr"}, linear(1e3, 1), 1e-6);
  // Sphere 0 is pushed to -x and pulled to +x.
  EXPECT_NEAR(press.s.force[0].x, -1e3 * press.overlap + 5e4 * area, 1e-10);
  EXPECT_NEAR(press.s.force[1].x, -press.s.force[0].x, 0);
}

TEST(TangentialHistory, SticksAsASpringThenSlides) {
  Press press;
  press.s.velocity[0] = {0, 0.01, 0};
  const double kt = 500, dt = 1e-5;
  press.evaluate({.normal = "hooke/stiffness", .tangential = "history"}, linear(1e3, kt), dt, 3);
  EXPECT_NEAR(press.s.force[0].y, -kt * 3 * dt * 0.01 - 0.5 * 0.01, 1e-15);
  press.evaluate({.normal = "hooke/stiffness", .tangential = "history"}, linear(1e3, 1e9), dt, 3);
  EXPECT_NEAR(press.s.force[0].y, -0.3 * 1e3 * press.overlap, 1e-15);
}

TEST(TangentialNoHistory, DampsUpToFriction) {
  Press press;
  press.s.velocity[0] = {0, 0.01, 0};
  press.evaluate({.normal = "hooke/stiffness", .tangential = "no_history"}, linear(1e3, 1), 1e-6);
  EXPECT_NEAR(press.s.force[0].y, -0.5 * 0.01, 1e-16);
  press.s.velocity[0] = {0, 10, 0};
  press.evaluate({.normal = "hooke/stiffness", .tangential = "no_history"}, linear(1e3, 1), 1e-6);
  EXPECT_NEAR(press.s.force[0].y, -0.3 * 1e3 * press.overlap, 1e-14);
}

TEST(RollingCdt, ConstantTorqueWithoutTorsion) {
  Press press;
  press.s.spin[0] = {3, 4, 0};
  const double reduced = press.r1 * press.r2 / (press.r1 + press.r2);
  const double size = 0.2 * 1e3 * press.overlap * reduced;
  const LawNames names{.normal = "hooke/stiffness", .rolling = "cdt"};
  press.evaluate(names, linear(1e3, 1), 1e-6);
  EXPECT_NEAR(press.s.torque[0].x, 0, 1e-18);
  EXPECT_NEAR(press.s.torque[0].y, -0.8 * size, 1e-15);
  TestMaterial torsion = linear(1e3, 1);
  torsion.options["torsionTorque"] = true;
  press.evaluate(names, torsion, 1e-6);
  EXPECT_NEAR(press.s.torque[0].x, -0.6 * size, 1e-15);
  EXPECT_NEAR(press.s.torque[1].x, 0.6 * size, 1e-15);
}

TEST(RollingEpsd2, ElasticThenLimited) {
  Press press;
  press.s.spin[0] = {0, 2, 0};
  const double reduced = press.r1 * press.r2 / (press.r1 + press.r2);
  const double kt = 400, dt = 1e-5;
  const LawNames names{.normal = "hooke/stiffness", .rolling = "epsd2"};
  press.evaluate(names, linear(1e3, kt), dt, 5);
  EXPECT_NEAR(press.s.torque[0].y, -5 * dt * kt * reduced * reduced * 2, 1e-18);
  press.evaluate(names, linear(1e3, 1e9), dt, 5);
  EXPECT_NEAR(press.s.torque[0].y, -0.2 * 1e3 * press.overlap * reduced, 1e-16);
}

TEST(ContactLaw, KeepsLinearAndAngularMomentum) {
  for (const char* tangential : {"history", "no_history"})
    for (const char* rolling : {"off", "cdt", "epsd2"}) {
      Press press;
      press.s.velocity[0] = {0.02, 0.05, -0.03};
      press.s.spin[0] = {3, -4, 5};
      press.s.spin[1] = {-1, 2, 6};
      press.evaluate({"hooke/stiffness", tangential, rolling, "sjkr"}, linear(1e3, 300), 1e-5, 4);
      const Spheres& s = press.s;
      EXPECT_EQ(norm(s.force[0] + s.force[1]), 0);
      EXPECT_GT(norm(s.torque[0]), 1e-6);
      const Vec3 moment = cross(s.position[0], s.force[0]) + cross(s.position[1], s.force[1]) +
                          s.torque[0] + s.torque[1];
      EXPECT_LT(norm(moment), 1e-15 * norm(s.torque[0]) * 10) << tangential << ' ' << rolling;
    }
}

TEST(ContactKernel, SaysWhichLawIsUnknown) {
  std::string unknown;
  EXPECT_FALSE(make_contact_kernel({.normal = "luding"}, unknown));
  EXPECT_EQ(unknown, "model luding");
  EXPECT_FALSE(make_contact_kernel({.normal = "hertz", .tangential = "magic"}, unknown));
  EXPECT_EQ(unknown, "tangential magic");
  EXPECT_FALSE(make_contact_kernel({.normal = "hertz", .rolling = "epsd3"}, unknown));
  EXPECT_EQ(unknown, "rolling_friction epsd3");
  EXPECT_FALSE(make_contact_kernel({.normal = "hertz", .cohesion = "sjkr2"}, unknown));
  EXPECT_EQ(unknown, "cohesion sjkr2");
}

} // namespace
} // namespace granflux::particle_subset::test
