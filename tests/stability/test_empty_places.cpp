// SPDX-FileCopyrightText: 2026 The GranFlux developers
// SPDX-License-Identifier: BSD-3-Clause

// Cells and ranks without particles, particles that all leave, no gravity.

#include <cmath>
#include <gtest/gtest.h>

#include "duct.hpp"

namespace {

using namespace granflux;
using namespace granflux::testing;

constexpr double d = 1e-3, cell = 3e-3;
constexpr cfd::Index3 cells{4, 4, 8};

FakeHost empty_host() {
  FakeHost host({0, 0, 0}, {cells[0] * cell, cells[1] * cell, cells[2] * cell}, {true, true, false},
                MPI_COMM_WORLD);
  host.slab_direction = 2; // all of the first particles are on the first rank
  return host;
}

void expect_closed(const coupling::ExchangeReport& report) {
  EXPECT_LT(report.volume_residual, 1e-12);
  EXPECT_LT(report.momentum_residual, 1e-12);
  EXPECT_LT(report.budget_residual, 1e-10);
}

// A heap at the inlet, on one rank, is blown out: ranks that had none get some, then no rank has
// any, and the gas goes on as if there had never been one.
TEST(EmptyPlaces, AllParticlesLeaveAndTheGasGoesOn) {
  for (const char* kernel : {"divided", "trilinear"}) {
    coupling::CouplingOptions options;
    options.void_fraction = kernel;
    coupling::Coupler coupler(upright_duct(cells, {cell, cell, cell}, 5), options, MPI_COMM_WORLD);
    FakeHost host = empty_host();
    add_lattice(host, {8, 8, 1}, 1.5e-3, d, 20, false);
    coupler.initialise(host.view(), 0);
    long left = 64;
    for (int step = 0; step < 150; ++step) {
      host.step(coupler, 2e-4, true, 2e-4);
      expect_closed(coupler.report());
      left = coupler.report().particles;
      host.remove([](const Particle& q) { return q.position.z > cells[2] * cell; });
    }
    EXPECT_EQ(left, 0) << kernel;
    EXPECT_EQ(coupler.report().void_fraction_min, 1);
    EXPECT_NEAR(largest(coupler.mesh(),
                        [&](std::size_t b, std::ptrdiff_t p) {
                          return std::abs(coupler.gas().velocity()[b][2][p] - 5);
                        }),
                0, 0.01)
        << kernel;
    EXPECT_GT(norm(coupler.report().carried_out), 0);
  }
}

TEST(EmptyPlaces, NoParticlesFromTheStart) {
  coupling::Coupler coupler(upright_duct(cells, {cell, cell, cell}, 1), {}, MPI_COMM_WORLD);
  FakeHost host = empty_host();
  coupler.initialise(host.view(), 0);
  for (int step = 0; step < 5; ++step)
    host.step(coupler, 1e-3, true, 1e-3);
  EXPECT_EQ(coupler.report().particles, 0);
  EXPECT_NEAR(pressure_drop(coupler), 0, 1e-9);
  expect_closed(coupler.report());
}

// Nothing moves where nothing pushes; a particle among gas at rest comes to rest.
TEST(EmptyPlaces, WithoutGravityWhatRestsKeepsResting) {
  cfd::GasCase c = closed_box({4, 4, 6}, cell);
  coupling::Coupler coupler(c, {}, MPI_COMM_WORLD);
  FakeHost host({0, 0, 0}, {4 * cell, 4 * cell, 6 * cell}, {}, MPI_COMM_WORLD);
  add_lattice(host, {8, 8, 8}, 1.5e-3, d, 2500, false);
  coupler.initialise(host.view(), 0);
  for (int step = 0; step < 20; ++step)
    host.step(coupler, 1e-2, true, 1e-2);
  for (const Vec3& v : host.velocity)
    EXPECT_EQ(norm(v), 0);
  EXPECT_EQ(largest(coupler.mesh(),
                    [&](std::size_t b, std::ptrdiff_t p) {
                      return std::abs(coupler.gas().velocity()[b][0][p]) +
                             std::abs(coupler.gas().pressure()[b][p]);
                    }),
            0);
}

} // namespace
