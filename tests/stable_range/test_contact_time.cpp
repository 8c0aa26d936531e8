// SPDX-FileCopyrightText: 2026 The GranFlux developers
// SPDX-License-Identifier: BSD-3-Clause

// Times of contacts against closed forms and against the motion itself, integrated here.
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>
#include <numbers>

#include "driver/contact_time.hpp"

using namespace granflux::driver;

namespace {

constexpr double pi = std::numbers::pi;

/// How long a mass that meets a wall at `speed` takes until its overlap is 0 again.
double time_of_contact(double mass, double speed,
                       const std::function<double(double overlap, double rate)>& force, double dt) {
  double x = 0, v = speed, t = 0;
  do {
    const double middle = v + 0.5 * dt / mass * force(x, v);
    const double half = x + 0.5 * dt * v;
    v += dt / mass * force(half, middle);
    x += dt * middle;
    t += dt;
  } while (x > 0);
  return t;
}

/// Largest |x| after n leapfrog steps of a spring whose dashpot sees the last half step's velocity.
double after_leapfrog(double k, double c, double m, double dt, int n) {
  double x = 1, v = 0;
  for (int i = 0; i < n; ++i) {
    v += dt / m * (-k * x - c * v);
    x += dt * v;
  }
  return std::abs(x);
}

} // namespace

TEST(ContactTime, LinearSpring) {
  const double k = 500, m = 2.6e-7;
  EXPECT_NEAR(contact_time({.stiffness = k}, m), pi * std::sqrt(m / k), 1e-15);
  // By restitution e: c = -2 ln e sqrt(k m / (pi^2 + ln^2 e)), and the time is longer by the same
  // root.
  const double e = 0.7, log_e = std::log(e);
  const double c = -2 * log_e * std::sqrt(k * m / (pi * pi + log_e * log_e));
  const NormalSpring damped{.stiffness = k, .damping = c};
  EXPECT_NEAR(contact_time(damped, m), std::sqrt(m / k * (pi * pi + log_e * log_e)), 1e-12);
  const double dt = 1e-9;
  EXPECT_NEAR(contact_time(damped, m),
              time_of_contact(
                  m, 0.3, [&](double x, double v) { return -k * x - c * v; }, dt),
              2 * dt);
  EXPECT_EQ(contact_time({.stiffness = k, .damping = 2.1 * std::sqrt(k * m)}, m),
            std::numeric_limits<double>::infinity());
}

TEST(ContactTime, LongestStepOfASpringWithADashpot) {
  const double k = 500, m = 2.6e-7;
  for (const double ratio : {0., 0.1, 0.5, 2.}) {
    const double c = 2 * ratio * std::sqrt(k * m);
    const double step = longest_step({.stiffness = k, .damping = c}, m);
    EXPECT_LT(after_leapfrog(k, c, m, 0.99 * step, 400), 20) << ratio;
    EXPECT_GT(after_leapfrog(k, c, m, 1.01 * step, 400), 100) << ratio;
  }
}

TEST(ContactTime, Hertz) {
  const double radius = 2.5e-4, m = 2.6e-7, modulus = 4. / 3. * 5e6;
  for (const double speed : {0.01, 1.}) {
    const double time =
        hertz_contact_time({.hertzian = true, .stiffness = modulus}, m, radius, speed);
    const double dt = 1e-4 * time;
    EXPECT_NEAR(time,
                time_of_contact(
                    m, speed,
                    [&](double x, double) {
                      return x > 0 ? -modulus * std::sqrt(radius) * std::pow(x, 1.5) : 0;
                    },
                    dt),
                2e-4 * time);
    // As it stands in the books: 2.87 (m^2 / (R E*^2 v))^(1/5), with 4/3 E* for the stiffness.
    const double young = 0.75 * modulus;
    EXPECT_NEAR(time, 2.868 * std::pow(m * m / (radius * young * young * speed), 0.2), 1e-3 * time);
  }
}

// Quartz sand: r 0.1 mm, E 70 GPa, nu 0.25, 2650 kg/m3. The wave travels at 0.9174 of the shear
// wave's speed for this nu (Rayleigh's equation gives 0.9194).
TEST(ContactTime, Rayleigh) {
  const double radius = 1e-4, density = 2650, poisson = 0.25, shear = 70e9 / 2 / (1 + poisson);
  const double wave = std::sqrt(shear / density);
  const double time = rayleigh_time(radius, density, shear, poisson);
  EXPECT_NEAR(time, pi * radius / (0.9194 * wave), 3e-3 * time);
  EXPECT_NEAR(rayleigh_time(2 * radius, 4 * density, shear, poisson), 4 * time, 1e-15);
}

TEST(ContactTime, ShortestOfAllPairs) {
  const double density = 1000;
  const auto sphere = [&](double radius, double young) {
    return ParticleType{.least_radius = radius,
                        .least_mass = density * 4 * pi / 3 * radius * radius * radius,
                        .young = young,
                        .poisson = 0.3};
  };
  // Type 2 is the smallest; there is none of type 3.
  const std::vector<ParticleType> types{sphere(1e-3, 5e6), sphere(2e-4, 1e6), {}};
  const auto constant = [](int a, int b, double, double) {
    EXPECT_LT(std::max(a, b), 3);
    return NormalSpring{.stiffness = a == b ? 500. : 5e5};
  };
  const ContactTimes times = shortest_times(types, constant);
  const double light = types[1].least_mass, heavy = types[0].least_mass;
  const double mixed = pi * std::sqrt(light * heavy / (light + heavy) / 5e5);
  EXPECT_EQ(times.linear.first, 1);
  EXPECT_EQ(times.linear.second, 2);
  EXPECT_NEAR(times.linear.seconds, mixed, 1e-12);
  EXPECT_EQ(times.rayleigh.first, 2);
  EXPECT_EQ(times.least_radius, 2e-4);
  EXPECT_EQ(times.hertzian.seconds, 0);
  EXPECT_NEAR(ContactTimes::at_speed({2e-5, 1, 1}, 32), 1e-5, 1e-18);
}
