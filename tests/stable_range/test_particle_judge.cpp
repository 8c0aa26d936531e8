// SPDX-FileCopyrightText: 2026 The GranFlux developers
// SPDX-License-Identifier: BSD-3-Clause

// Particles that are not to be believed are found on all ranks alike, and named by the rank that
// has them.
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>

#include <mpi.h>

#include "driver/particle_probe.hpp"

using namespace granflux;
using namespace granflux::driver;

namespace {

constexpr double not_a_number = std::numeric_limits<double>::quiet_NaN();
constexpr double inf = std::numeric_limits<double>::infinity();

struct Cloud {
  static constexpr std::size_t n = 50;
  std::vector<Vec3> position{n}, velocity{n}, force{n};
  std::vector<double> radius = std::vector<double>(n, 1e-3), mass = std::vector<double>(n, 1e-6),
                      temperature = std::vector<double>(n, 300);
  std::vector<std::int64_t> id;
  std::vector<std::uint8_t> fixed = std::vector<std::uint8_t>(n, 0);
  std::vector<coupling::FluidState> fluid{n};

  Cloud() {
    for (std::size_t p = 0; p < n; ++p) {
      position[p] = {0.001 * double(p), 0, 0.5};
      velocity[p] = {0, -0.1 * double(p), 0};
      force[p] = {1e-5, 0, 0};
      id.push_back(std::int64_t(1000 + p));
    }
    radius[7] = 5e-4, radius[9] = 2e-3, mass[3] = 1e-7;
  }
  coupling::ParticleView view() {
    coupling::ParticleView view;
    view.position = position, view.velocity = velocity, view.force = force;
    view.radius = radius, view.mass = mass, view.id = id, view.fluid = fluid;
    view.fixed = fixed, view.temperature = temperature;
    return view;
  }
};

/// Of a cloud that was spoilt on the last rank.
void expect_found(const std::function<void(Cloud&)>& spoil, const char* text,
                  ParticleJudge judge = {.time_step = 1e-5}) {
  int rank = 0, ranks = 1;
  MPI_Comm_rank(MPI_COMM_WORLD, &rank);
  MPI_Comm_size(MPI_COMM_WORLD, &ranks);
  Cloud cloud;
  if (rank == ranks - 1)
    spoil(cloud);
  EXPECT_EQ(judge.look(cloud.view(), MPI_COMM_WORLD).good, text == nullptr);
  const std::string complaint = judge.complaint(cloud.view());
  if (text && rank == ranks - 1) {
    EXPECT_NE(complaint.find(text), std::string::npos) << complaint;
    EXPECT_NE(complaint.find("particle 1013 at (0.013, "), std::string::npos) << complaint;
  } else {
    EXPECT_EQ(complaint, "");
  }
}

} // namespace

TEST(ParticleJudge, ExtremesOfAllRanks) {
  Cloud cloud;
  const ParticleProbe found = ParticleJudge{.time_step = 1e-5}.look(cloud.view(), MPI_COMM_WORLD);
  EXPECT_TRUE(found.good);
  EXPECT_DOUBLE_EQ(found.speed, 4.9);
  EXPECT_DOUBLE_EQ(found.speed_over_radius, 4900);
  EXPECT_EQ(found.least_radius, 5e-4);
  EXPECT_EQ(found.largest_radius, 2e-3);
  EXPECT_EQ(found.least_mass, 1e-7);
  const ParticleProbe none = ParticleJudge{.time_step = 1e-5}.look({}, MPI_COMM_WORLD);
  EXPECT_TRUE(none.good);
  EXPECT_EQ(none.largest_radius, 0);
}

TEST(ParticleJudge, NotANumber) {
  for (const double bad : {not_a_number, inf, -inf}) {
    expect_found([&](Cloud& c) { c.velocity[13].y = bad; }, "not a number");
    expect_found([&](Cloud& c) { c.force[13].z = bad; }, "not a number");
    expect_found([&](Cloud& c) { c.temperature[13] = bad; }, "temperature");
  }
  expect_found([&](Cloud& c) { c.position[13].z = not_a_number; }, "not a number");
  expect_found([&](Cloud& c) { c.temperature[13] = -1; }, "temperature -1 K");
  expect_found([&](Cloud& c) { c.temperature[13] = 0; }, nullptr);
}

// m r / dt^2 = 10 N moves a particle by its radius in a step.
TEST(ParticleJudge, ForceThatNoStepResolves) {
  expect_found([](Cloud& c) { c.force[13] = {6, 0, 8.1}; }, "its force of 10.1 N moves it by 1.01");
  expect_found([](Cloud& c) { c.force[13] = {6, 0, 7.9}; }, nullptr);
  expect_found([](Cloud& c) { c.force[13] = {6, 0, 8.1}, c.fixed[13] = 1; }, nullptr);
}

TEST(ParticleJudge, PathOnlyWhereContactsAreBeyond) {
  const auto quick = [](Cloud& c) { c.velocity[13] = {0, 0, 150}; };
  expect_found(quick, nullptr);
  expect_found(quick, "moves by 1.5 of its radius", {.time_step = 1e-5, .judge_path = true});
}
