// SPDX-FileCopyrightText: 2026 The GranFlux developers
// SPDX-License-Identifier: BSD-3-Clause

// Particles in the gas of a drum of five blocks along its axis: what is true of boxes is true here.

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>

#include <gtest/gtest.h>

#include <granflux/cfd/error.hpp>
#include <granflux/cfd/sweep.hpp>

#include "fake_host.hpp"

namespace {

using namespace granflux;

constexpr double radius = 0.05, length = 0.08; // of the drum [m]

cfd::GasCase drum_case(bool periodic) {
  cfd::GasCase c;
  cfd::CylinderGrid grid;
  grid.radius = radius, grid.length = length;
  grid.core = 4, grid.radial = 3, grid.axial = 6;
  grid.axial_blocks = 2;
  grid.periodic_axis = periodic;
  c.grid = grid;
  cfd::BoundaryCondition wall;
  wall.name = "wall";
  wall.kind = cfd::BoundaryKind::slip;
  c.boundaries = {wall};
  c.fluid.density = 1.2;
  c.fluid.viscosity = 1.8e-5;
  c.numerics.pressure_tolerance = 1e-12;
  return c;
}

granflux::testing::FakeHost drum_host(bool periodic) {
  granflux::testing::FakeHost host({-radius, -radius, 0}, {radius, radius, length},
                                   {false, false, periodic}, MPI_COMM_WORLD);
  host.slab_direction = 2;
  return host;
}

/// Anywhere in the drum, off the wall.
void add_cloud(granflux::testing::FakeHost& host, int count, double particle_radius) {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> unit(0, 1);
  for (int p = 0; p < count; ++p) {
    const double angle = 2 * std::numbers::pi * unit(random);
    const double r = 0.94 * radius * std::sqrt(unit(random));
    const Vec3 x{r * std::cos(angle), r * std::sin(angle), length * unit(random)};
    host.add(granflux::testing::sphere(p, x, {0, 0, 0.1 * unit(random)}, particle_radius, 2500));
  }
}

TEST(Drum, VolumeAndMomentumClose) {
  for (const char* kernel : {"centre", "divided", "smoothed"}) {
    SCOPED_TRACE(kernel);
    cfd::GasCase c = drum_case(true);
    c.boundaries[0].kind = cfd::BoundaryKind::wall;
    c.boundaries[0].angular_velocity = {0, 0, 3};
    c.initial_velocity = {0, 0, 1};
    coupling::CouplingOptions options;
    options.void_fraction = kernel;
    coupling::Coupler coupler(c, options, MPI_COMM_WORLD);
    granflux::testing::FakeHost host = drum_host(true);
    add_cloud(host, 500, 1e-3);
    coupler.initialise(host.view(), 0);
    for (int s = 0; s < 10; ++s) {
      host.step(coupler, 1e-3, true, 1e-3);
      EXPECT_EQ(coupler.report().particles, 500);
      EXPECT_LT(coupler.report().volume_residual, 1e-12);
      EXPECT_LT(coupler.report().momentum_residual, 1e-12);
      EXPECT_LT(coupler.report().budget_residual, 1e-9);
    }
  }
}

/// Closed form: with walls that bear nothing, all ends at the momentum of the start over the mass.
TEST(Drum, GasAndParticlesEndAtOneVelocity) {
  cfd::GasCase c = drum_case(true);
  c.initial_velocity = {0, 0, 1};
  c.fluid.viscosity = 1.8e-3; // evens out what differs between the axis and the wall
  coupling::CouplingOptions options;
  options.void_fraction = "smoothed";
  options.drag = "stokes";
  coupling::Coupler coupler(c, options, MPI_COMM_WORLD);
  granflux::testing::FakeHost host = drum_host(true);
  add_cloud(host, 4000, 1e-4);
  coupler.initialise(host.view(), 0);
  // What the void fraction left of the gas, at 1 m/s, and the particles.
  const double particles = host.momentum().z;
  constexpr double dt = 5e-3;
  double mass[2] = {0, 0};
  for (const double m : host.mass)
    mass[0] += m, mass[1] += m / 2500;
  MPI_Allreduce(MPI_IN_PLACE, mass, 2, MPI_DOUBLE, MPI_SUM, MPI_COMM_WORLD);
  double space = 0;
  for (const cfd::Block& block : coupler.mesh().local)
    cfd::for_cells(block.layout, [&](std::ptrdiff_t p) {
#pragma omp atomic
      space += block.volume[p];
    });
  MPI_Allreduce(MPI_IN_PLACE, &space, 1, MPI_DOUBLE, MPI_SUM, MPI_COMM_WORLD);
  const double gas_mass = 1.2 * (space - mass[1]);
  const double total = particles + gas_mass;
  constexpr int steps = 300;
  for (int s = 0; s < steps; ++s)
    host.step(coupler, dt, true, dt);
  EXPECT_NEAR(coupler.gas().balance().momentum.z + host.momentum().z, total, steps * 1e-13 * total);
  double slowest = 1e300, fastest = -1e300;
  for (const Vec3& v : host.velocity)
    slowest = std::min(slowest, v.z), fastest = std::max(fastest, v.z);
  const double end = total / (gas_mass + mass[0]);
  EXPECT_NEAR(slowest, end, 1e-4 * end);
  EXPECT_NEAR(fastest, end, 1e-4 * end);
}

/// Cells filled alike with small equal spheres: Ergun's pressure drop.
TEST(Drum, PackedBedObeysErgun) {
  constexpr double eps = 0.5, velocity = 0.05, d = 2e-3;
  cfd::GasCase c = drum_case(false);
  cfd::BoundaryCondition inlet, outlet;
  inlet.name = "low";
  inlet.kind = cfd::BoundaryKind::inlet;
  inlet.velocity = {0, 0, velocity};
  outlet.name = "high";
  outlet.kind = cfd::BoundaryKind::outlet;
  c.boundaries.push_back(inlet);
  c.boundaries.push_back(outlet);
  coupling::CouplingOptions options;
  options.void_fraction = "centre";
  options.drag = "ergun";
  coupling::Coupler coupler(c, options, MPI_COMM_WORLD);
  granflux::testing::FakeHost host = drum_host(false);
  // As many in every cell as come closest to 1 - eps, all in its centre.
  const cfd::Mesh& mesh = coupler.mesh();
  std::vector<double> mine, all;
  double solid = 0, space = 0;
  for (const cfd::Block& block : mesh.local)
    for (int k = 0; k < block.layout.cells[2]; ++k)
      for (int j = 0; j < block.layout.cells[1]; ++j)
        for (int i = 0; i < block.layout.cells[0]; ++i) {
          const std::ptrdiff_t p = block.layout.at(i, j, k);
          const double each = granflux::testing::sphere_volume(d / 2);
          const double count = std::round((1 - eps) * block.volume[p] / each);
          mine.insert(mine.end(),
                      {block.centre[0][p], block.centre[1][p], block.centre[2][p], count});
          solid += count * each;
          space += block.volume[p];
        }
  int ranks = 1;
  MPI_Comm_size(MPI_COMM_WORLD, &ranks);
  std::vector<int> counts(std::size_t(ranks), 0), starts(std::size_t(ranks), 0);
  const int own = int(mine.size());
  MPI_Allgather(&own, 1, MPI_INT, counts.data(), 1, MPI_INT, MPI_COMM_WORLD);
  for (std::size_t r = 1; r < starts.size(); ++r)
    starts[r] = starts[r - 1] + counts[r - 1];
  all.resize(std::size_t(starts.back() + counts.back()));
  MPI_Allgatherv(mine.data(), own, MPI_DOUBLE, all.data(), counts.data(), starts.data(), MPI_DOUBLE,
                 MPI_COMM_WORLD);
  std::int64_t id = 0;
  for (std::size_t n = 0; n < all.size(); n += 4)
    for (int count = 0; count < int(all[n + 3]); ++count)
      host.add(
          granflux::testing::sphere(id++, {all[n], all[n + 1], all[n + 2]}, {}, d / 2, 2500, true));
  coupler.initialise(host.view(), 0);
  for (int s = 0; s < 20; ++s)
    host.step(coupler, 5e-3, true, 5e-3);
  double sums[2] = {solid, space};
  MPI_Allreduce(MPI_IN_PLACE, sums, 2, MPI_DOUBLE, MPI_SUM, MPI_COMM_WORLD);
  const double e = 1 - sums[0] / sums[1];
  const double ergun = 150 * (1 - e) * (1 - e) / (e * e * e) * 1.8e-5 * velocity / (d * d) +
                       1.75 * (1 - e) / (e * e * e) * 1.2 * velocity * velocity / d;
  // The wall is made of flat faces: less area than the circle, so more flow through each.
  const double drop =
      coupler.gas().boundary_pressure("low") - coupler.gas().boundary_pressure("high");
  EXPECT_NEAR(drop / (ergun * length), 1, 0.01);
}

TEST(Drum, SharesAlongLinesOfCellsNeedABox) {
  for (const char* kernel : {"trilinear", "spline"}) {
    coupling::CouplingOptions options;
    options.void_fraction = kernel;
    EXPECT_THROW(coupling::Coupler(drum_case(true), options, MPI_COMM_WORLD), ConfigError);
  }
}

} // namespace
