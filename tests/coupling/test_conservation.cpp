// SPDX-FileCopyrightText: 2026 The GranFlux developers
// SPDX-License-Identifier: BSD-3-Clause

// The books of the exchange, each coupling step: a cloud of particles in an upflow, moving across
// blocks and ranks, some on their faces, some leaving through the outlet, some inserted and some
// deleted on the way.

#include <cmath>
#include <gtest/gtest.h>
#include <random>

#include <granflux/cfd/error.hpp>
#include <granflux/coupling/drag/schiller_naumann.hpp>

#include "fake_host.hpp"
#include "saved_state.hpp"

namespace {

using namespace granflux;
using granflux::testing::FakeHost;
using granflux::testing::load;
using granflux::testing::Particle;
using granflux::testing::saved;
using granflux::testing::sphere;

constexpr double d = 1e-3; // m
const Vec3 box{16e-3, 8e-3, 24e-3};

cfd::GasCase upflow(bool periodic_sides) {
  cfd::GasCase c;
  box_grid(c).nodes = {cfd::uniform_nodes(0, box.x, 8), cfd::uniform_nodes(0, box.y, 4),
                       cfd::uniform_nodes(0, box.z, 12)};
  box_grid(c).blocks = {2, 1, 2};
  box_grid(c).periodic = {periodic_sides, false, false};
  box_grid(c).patches = {
      {"front", {1, false}}, {"back", {1, true}}, {"in", {2, false}}, {"out", {2, true}}};
  c.boundaries = {{.name = "front", .kind = cfd::BoundaryKind::wall},
                  {.name = "back", .kind = cfd::BoundaryKind::slip},
                  {.name = "in", .kind = cfd::BoundaryKind::inlet, .velocity = {0, 0, 1.5}},
                  {.name = "out", .kind = cfd::BoundaryKind::outlet}};
  if (!periodic_sides) {
    box_grid(c).patches.push_back({"left", {0, false}});
    box_grid(c).patches.push_back({"right", {0, true}});
    c.boundaries.push_back({.name = "left", .kind = cfd::BoundaryKind::wall});
    c.boundaries.push_back({.name = "right", .kind = cfd::BoundaryKind::wall});
  }
  c.fluid = {.density = 1.2, .viscosity = 1.8e-5, .gravity = {0, 0, -9.81}};
  return c;
}

/// A lattice of particles with their centres on cell faces, every fourth of them at random.
void fill(FakeHost& host, bool fixed = false) {
  std::mt19937 random(20140401);
  std::uniform_real_distribution<double> share(0, 1);
  std::int64_t id = 1;
  for (int k = 0; k < 10; ++k)
    for (int j = 1; j < 4; ++j)
      for (int i = 0; i < 8; ++i, ++id) {
        Vec3 x{i * 2e-3, j * 2e-3, 1e-3 + k * 2e-3};
        if (id % 4 == 0)
          x = {box.x * share(random), box.y * share(random), box.z * share(random)};
        host.add(sphere(id, x, {0, 0, 0.2 * share(random)}, d / 2, 20, fixed));
      }
}

void expect_closed_books(const coupling::ExchangeReport& report) {
  EXPECT_LT(report.volume_residual, 1e-12);
  EXPECT_LT(report.momentum_residual, 1e-12);
  EXPECT_LT(report.budget_residual, 1e-10);
}

struct Scene {
  const char* kernel;
  coupling::MomentumModel model;
  bool periodic;
};

class Conservation : public ::testing::TestWithParam<Scene> {};

TEST_P(Conservation, BooksCloseEachStepWithParticlesOnFacesLeavingInsertedAndDeleted) {
  const Scene scene = GetParam();
  coupling::CouplingOptions options;
  options.void_fraction = scene.kernel;
  options.model = scene.model;
  coupling::Coupler coupler(upflow(scene.periodic), options, MPI_COMM_WORLD);
  FakeHost host({0, 0, 0}, box, {scene.periodic, false, false}, MPI_COMM_WORLD);
  host.gravity = {0, 0, -9.81};
  host.other_force = [](const Particle& q) { // a spring that stands for contacts
    return -0.02 * q.mass * 1e3 * Vec3{0, q.position.y - box.y / 2, 0};
  };
  fill(host);
  coupler.initialise(host.view(), 0);

  const double dt = 5e-5;
  const int every = 4;
  const Vec3 initial = host.momentum();
  Vec3 inserted, removed;
  bool left = false;
  for (int step = 0; step < 160; ++step) {
    host.step(coupler, dt, step % every == 0, every * dt);
    if (step % every == 0) {
      const auto& report = coupler.report();
      expect_closed_books(report);
      left = left || report.outside > 0;
      EXPECT_GT(report.particles, 0);
    }
    if (step == 41) { // between two coupling steps: impulses are on their way
      removed += host.remove([](const Particle& q) { return q.id % 5 == 0; });
      const Particle p = sphere(1000, {8e-3, 4e-3, 12e-3}, {0, 0, -1}, d / 2, 20);
      host.add(p);
      inserted += p.mass * p.velocity;
    }
  }
  EXPECT_TRUE(left) << "the test is to have particles that leave through the outlet";

  // One more exchange, with the particles where they are: its report has all impulses applied.
  coupler.exchange(host.view(), every * dt);
  expect_closed_books(coupler.report());
  const Vec3 gained = host.momentum() - initial - inserted + host.total(removed) -
                      host.total(host.external_impulse);
  const Vec3 error = gained - coupler.report().impulse_to_particles;
  EXPECT_LT(norm(error), 1e-11 * norm(coupler.report().impulse_to_particles));
  EXPECT_GT(norm(coupler.report().carried_out), 0);
}

INSTANTIATE_TEST_SUITE_P(Kernels, Conservation,
                         ::testing::Values(Scene{"centre", coupling::MomentumModel::a, false},
                                           Scene{"divided", coupling::MomentumModel::a, true},
                                           Scene{"trilinear", coupling::MomentumModel::b, true},
                                           Scene{"spline", coupling::MomentumModel::a, true},
                                           Scene{"smoothed", coupling::MomentumModel::a, true},
                                           Scene{"smoothed", coupling::MomentumModel::b, false}),
                         [](const auto& scene) {
                           return std::string(scene.param.kernel) +
                                  (scene.param.model == coupling::MomentumModel::a ? "A" : "B") +
                                  (scene.param.periodic ? "Periodic" : "Walled");
                         });

TEST(Exchange, FreeParticleReceivesWhatTheGasWasChargedFor) {
  // Without contacts, gravity and pressure gradient the charge is exact in one interval, whatever
  // the number of particle steps in it.
  cfd::GasCase c = upflow(true);
  c.fluid.gravity = {};
  coupling::CouplingOptions options;
  options.model = coupling::MomentumModel::b;
  coupling::Coupler coupler(c, options, MPI_COMM_WORLD);
  FakeHost host({0, 0, 0}, box, {true, false, false}, MPI_COMM_WORLD);
  fill(host);
  coupler.initialise(host.view(), 0);
  const double interval = 2e-4;
  host.step(coupler, interval / 8, true, interval);
  for (int sub = 1; sub < 8; ++sub)
    host.step(coupler, interval / 8, false, interval);
  for (std::size_t p = 0; p < host.size(); ++p) {
    const coupling::FluidState& state = host.fluid[p];
    EXPECT_LT(norm(state.hand_over), 1e-12 * interval * norm(state.force) + 1e-25);
  }
}

TEST(Exchange, TakesBackWhatTheIntegratorDidNotApply) {
  coupling::Coupler coupler(upflow(true), {}, MPI_COMM_WORLD);
  FakeHost host({0, 0, 0}, box, {true, false, false}, MPI_COMM_WORLD);
  fill(host);
  coupler.initialise(host.view(), 0);
  coupler.exchange(host.view(), 1e-4);
  const auto none = host.fluid;
  coupler.apply(host.view(), 1e-4, 0.5);
  const auto half = host.fluid;
  coupler.unapply(host.view(), 1e-4, 0.25);
  for (std::size_t p = 0; p < host.size(); ++p) {
    const Vec3 impulse = half[p].hand_over - none[p].hand_over;
    EXPECT_LT(norm(0.5 * impulse - (host.fluid[p].hand_over - none[p].hand_over)),
              1e-14 * norm(impulse));
  }
  coupler.exchange(host.view(), 1e-4);
  expect_closed_books(coupler.report());
}

TEST(Exchange, ParticlesBeyondTheLawAreCounted) {
  coupling::CouplingOptions options;
  options.drag = "schiller_naumann";
  coupling::Coupler coupler(upflow(true), options, MPI_COMM_WORLD);
  FakeHost host({0, 0, 0}, box, {true, false, false}, MPI_COMM_WORLD);
  fill(host);
  coupler.initialise(host.view(), 0);
  coupler.exchange(host.view(), 1e-4);
  const auto valid = coupling::SchillerNaumann::valid;
  double beyond = 0;
  for (const coupling::FluidState& state : host.fluid)
    beyond += !valid.void_fraction.contains(state.void_fraction);
  MPI_Allreduce(MPI_IN_PLACE, &beyond, 1, MPI_DOUBLE, MPI_SUM, MPI_COMM_WORLD);
  EXPECT_EQ(coupler.report().law_out_of_range, long(beyond));
  EXPECT_GT(beyond, 20);
  EXPECT_LT(beyond, 220); // of 240
  EXPECT_LT(coupler.report().slip_reynolds_max, valid.reynolds.high);
}

TEST(Exchange, FixedParticlesAreChargedInFull) {
  coupling::Coupler coupler(upflow(true), {}, MPI_COMM_WORLD);
  FakeHost host({0, 0, 0}, box, {true, false, false}, MPI_COMM_WORLD);
  fill(host, true);
  coupler.initialise(host.view(), 0);
  for (int step = 0; step < 3; ++step) {
    host.step(coupler, 1e-3, true, 1e-3);
    expect_closed_books(coupler.report());
  }
  for (std::size_t p = 0; p < host.size(); ++p)
    EXPECT_LT(norm(host.fluid[p].hand_over), 1e-13 * 1e-3 * norm(host.fluid[p].force));
}

TEST(Exchange, RestartContinuesBitForBit) {
  const auto run = [](bool restart) {
    auto coupler = std::make_unique<coupling::Coupler>(upflow(true), coupling::CouplingOptions{},
                                                       MPI_COMM_WORLD);
    FakeHost host({0, 0, 0}, box, {true, false, false}, MPI_COMM_WORLD);
    host.gravity = {0, 0, -9.81};
    fill(host);
    coupler->initialise(host.view(), 0);
    for (int step = 0; step < 12; ++step) {
      if (restart && step == 6) {
        const std::vector<char> state = saved(*coupler);
        coupler = std::make_unique<coupling::Coupler>(upflow(true), coupling::CouplingOptions{},
                                                      MPI_COMM_WORLD);
        load(*coupler, state);
      }
      host.step(*coupler, 1e-4, step % 4 == 0, 4e-4);
    }
    const auto& report = coupler->report();
    std::vector<double> numbers = {report.drag.z, report.impulse_from_gas.z,
                                   report.impulse_to_particles.z, report.momentum_residual};
    for (const Vec3& v : host.velocity)
      numbers.insert(numbers.end(), {v.x, v.y, v.z});
    return numbers;
  };
  EXPECT_EQ(run(false), run(true));
}

TEST(Exchange, RefusesMoreParticlesThanARankCanNumberOnAllRanks) {
  coupling::CouplingOptions options;
  options.void_fraction = "divided";
  coupling::Coupler coupler(upflow(true), options, MPI_COMM_WORLD);
  const Vec3 alone;
  coupling::ParticleView view; // nothing of it is read before it is counted
  int rank = 0;
  MPI_Comm_rank(MPI_COMM_WORLD, &rank);
  if (rank == 0)
    view.position = {&alone, (std::size_t{1} << 27) + 1};
  try {
    coupler.initialise(view, 0);
    FAIL() << "no error";
  } catch (const ConfigError& e) {
    EXPECT_NE(std::string(e.what()).find("134217729 particles on one rank"), std::string::npos);
    EXPECT_NE(std::string(e.what()).find("134217728 at most"), std::string::npos);
  }
}

TEST(Exchange, NamesTheParticleOutsideTheGridOnAllRanks) {
  coupling::Coupler coupler(upflow(true), {}, MPI_COMM_WORLD);
  FakeHost host({0, 0, 0}, box, {true, false, false}, MPI_COMM_WORLD);
  fill(host);
  host.add(sphere(4711, {4e-3, 4e-3, 25e-3}, {}, d / 2, 20));
  try {
    coupler.initialise(host.view(), 0);
    FAIL() << "no error";
  } catch (const ConfigError& e) {
    const std::string text = e.what();
    EXPECT_NE(text.find("4711"), std::string::npos) << text;
    EXPECT_NE(text.find("0.025"), std::string::npos) << text;
    EXPECT_NE(text.find("0.024"), std::string::npos) << text;
  }
}

TEST(Exchange, StopsOnAllRanksWhereACellIsOverfull) {
  coupling::CouplingOptions options;
  options.void_fraction = "centre";
  coupling::Coupler coupler(upflow(true), options, MPI_COMM_WORLD);
  FakeHost host({0, 0, 0}, box, {true, false, false}, MPI_COMM_WORLD);
  for (int p = 0; p < 30; ++p)
    host.add(sphere(p, {5e-3, 5e-3, 5e-3}, {}, d / 2, 20));
  try {
    coupler.initialise(host.view(), 0);
    FAIL() << "no error";
  } catch (const NumericalError& e) {
    const std::string text = e.what();
    EXPECT_NE(text.find("void fraction"), std::string::npos) << text;
    EXPECT_NE(text.find("block"), std::string::npos) << text;
    EXPECT_NE(text.find("(0.005, 0.005, 0.005)"), std::string::npos) << text;
  }
}

} // namespace
