// SPDX-FileCopyrightText: 2026 The GranFlux developers
// SPDX-License-Identifier: BSD-3-Clause

// The same particles and gas on all ranks of the run and, inside the same test, on one rank alone:
// the sums of the exchange agree to 1e-13.

#include <cmath>
#include <gtest/gtest.h>
#include <random>

#include "fake_host.hpp"

namespace {

using namespace granflux;
using granflux::testing::FakeHost;
using granflux::testing::sphere;

const Vec3 box{20e-3, 8e-3, 24e-3};

cfd::GasCase make_case() {
  cfd::GasCase c;
  box_grid(c).nodes = {cfd::uniform_nodes(0, box.x, 10), cfd::uniform_nodes(0, box.y, 4),
                       cfd::uniform_nodes(0, box.z, 12)};
  box_grid(c).periodic = {true, false, false};
  box_grid(c).patches = {
      {"front", {1, false}}, {"back", {1, true}}, {"in", {2, false}}, {"out", {2, true}}};
  c.boundaries = {{.name = "front", .kind = cfd::BoundaryKind::wall},
                  {.name = "back", .kind = cfd::BoundaryKind::wall},
                  {.name = "in", .kind = cfd::BoundaryKind::inlet, .velocity = {0, 0, 1}},
                  {.name = "out", .kind = cfd::BoundaryKind::outlet}};
  c.fluid = {.density = 1.2, .viscosity = 1.8e-5, .gravity = {0, 0, -9.81}};
  c.numerics.pressure_tolerance = 1e-15; // or the solver's tolerance would be all there is to see
  c.numerics.viscous_tolerance = 1e-15;
  return c;
}

struct Sum {
  double value, scale; ///< scale: what round-off is to be measured by
};

/// Sums of some coupling steps of a fixed set of particles.
std::vector<Sum> sums(MPI_Comm comm, int slab_direction, const char* kernel) {
  coupling::CouplingOptions options;
  options.void_fraction = kernel;
  coupling::Coupler coupler(make_case(), options, comm);
  FakeHost host({0, 0, 0}, box, {true, false, false}, comm);
  host.slab_direction = slab_direction;
  std::mt19937 random(7);
  std::uniform_real_distribution<double> share(0, 1);
  for (int p = 0; p < 400; ++p) {
    Vec3 x{box.x * share(random), box.y * share(random), 0.6 * box.z * share(random)};
    if (p % 5 == 0) // on faces of cells, blocks and ranks
      x = {2e-3 * (p % 10), 2e-3 * (p / 10 % 4), 2e-3 * (p / 40)};
    const Vec3 v{share(random) - 0.5, share(random) - 0.5, share(random) - 0.5};
    host.add(sphere(p, x, v, 0.3e-3 + 0.3e-3 * share(random), 1000));
  }
  coupler.initialise(host.view(), 0);
  std::vector<Sum> found;
  for (int step = 0; step < 3; ++step) {
    coupler.exchange(host.view(), 1e-4);
    coupler.apply(host.view(), 1e-4);
    const auto& r = coupler.report();
    for (const double x : {r.particle_volume, r.void_fraction_min, r.slip_reynolds_max,
                           double(r.particles), double(r.law_out_of_range)})
      found.push_back({x, x});
    const double force = norm(r.drag) + norm(r.pressure_force);
    const double impulse = norm(r.impulse_from_gas);
    for (int k = 0; k < 3; ++k) {
      found.push_back({r.drag[k], force});
      found.push_back({r.pressure_force[k], force});
      found.push_back({r.impulse_from_gas[k], impulse});
      found.push_back({r.impulse_to_particles[k], impulse});
      found.push_back({r.in_transit[k], impulse});
    }
  }
  return found;
}

class RankEquality : public ::testing::TestWithParam<const char*> {};

TEST_P(RankEquality, SumsAgreeWithOneRankAlone) {
  const std::vector<Sum> alone = sums(MPI_COMM_SELF, 0, GetParam());
  for (const int direction : {0, 2}) { // rank faces across and along the cut of the gas
    const std::vector<Sum> together = sums(MPI_COMM_WORLD, direction, GetParam());
    for (std::size_t i = 0; i < alone.size(); ++i)
      EXPECT_NEAR(together[i].value, alone[i].value, 1e-13 * alone[i].scale) << "sum " << i;
  }
}
INSTANTIATE_TEST_SUITE_P(Kernels, RankEquality,
                         ::testing::Values("centre", "divided", "trilinear", "spline", "smoothed"),
                         [](const auto& kernel) { return std::string(kernel.param); });

} // namespace
