// SPDX-FileCopyrightText: 2026 The GranFlux developers
// SPDX-License-Identifier: BSD-3-Clause

// Pressure drop over a lattice of 10 000 fixed spheres of 1 mm at void fraction 0.451335, gas of
// 10 kg/m3 and 1.5e-3 Pa s: the numbers of CFDEM's ErgunTestMPI, against Ergun's equation
//   dp/L = 150 (1-eps)^2/eps^3 mu U/d^2 + 1.75 (1-eps)/eps^3 rho U^2/d.
// At eps 0.451335 the lattice constant is below d: fixed spheres may overlap.

#include <cmath>
#include <gtest/gtest.h>
#include <numbers>

#include "fake_host.hpp"

namespace {

using namespace granflux;
using granflux::testing::FakeHost;
using granflux::testing::sphere;

constexpr double d = 1e-3, eps = 0.451335, rho = 10, mu = 1.5e-3;
constexpr std::array<int, 3> spheres{20, 20, 25};
constexpr double velocities[] = {0.002, 0.005, 0.010, 0.015, 0.020}; // superficial, m/s

double lattice_constant() {
  return d * std::cbrt(std::numbers::pi / 6 / (1 - eps));
}
double bed_length() {
  return spheres[2] * lattice_constant();
}

double ergun_drop(double u) {
  const double e3 = eps * eps * eps;
  return bed_length() * (150 * (1 - eps) * (1 - eps) / e3 * mu * u / (d * d) +
                         1.75 * (1 - eps) / e3 * rho * u * u / d);
}

struct Drops {
  double boundaries = 0; ///< pressure at inlet less outlet [Pa]
  double on_spheres = 0; ///< force on the spheres over the cross-section [Pa]
};

/// `drag_factor` multiplies the drag: at a fixed Re it is proportional to density and viscosity.
Drops pressure_drop(double u, const char* kernel, coupling::MomentumModel model,
                    double drag_factor) {
  const double a = lattice_constant();
  cfd::GasCase c;
  for (std::size_t k = 0; k < 3; ++k)
    box_grid(c).nodes[k] = cfd::uniform_nodes(0, spheres[k] * a, spheres[k] / 5);
  box_grid(c).patches = {{"in", {2, false}},  {"out", {2, true}},    {"west", {0, false}},
                         {"east", {0, true}}, {"front", {1, false}}, {"back", {1, true}}};
  for (const char* side : {"west", "east", "front", "back"})
    c.boundaries.push_back({.name = side, .kind = cfd::BoundaryKind::slip});
  c.boundaries.push_back({.name = "in", .kind = cfd::BoundaryKind::inlet, .velocity = {0, 0, u}});
  c.boundaries.push_back({.name = "out", .kind = cfd::BoundaryKind::outlet});
  c.fluid = {.density = rho * drag_factor, .viscosity = mu * drag_factor};
  coupling::CouplingOptions options;
  options.void_fraction = kernel;
  options.model = model;
  coupling::Coupler coupler(c, options, MPI_COMM_WORLD);
  FakeHost host({0, 0, 0}, {spheres[0] * a, spheres[1] * a, spheres[2] * a}, {}, MPI_COMM_WORLD);
  std::int64_t id = 1;
  for (int k = 0; k < spheres[2]; ++k)
    for (int j = 0; j < spheres[1]; ++j)
      for (int i = 0; i < spheres[0]; ++i)
        host.add(
            sphere(id++, {(i + 0.5) * a, (j + 0.5) * a, (k + 0.5) * a}, {}, d / 2, 2000, true));
  coupler.initialise(host.view(), 0);
  for (int step = 0; step < 30; ++step) {
    coupler.exchange(host.view(), 0.05);
    coupler.apply(host.view(), 0.05);
    EXPECT_LT(coupler.report().volume_residual, 1e-12);
    EXPECT_LT(coupler.report().momentum_residual, 1e-12);
    EXPECT_LT(coupler.report().budget_residual, 1e-10);
  }
  const auto& report = coupler.report();
  return {coupler.gas().boundary_pressure("in") - coupler.gas().boundary_pressure("out"),
          (report.drag.z + report.pressure_force.z) / (spheres[0] * a * spheres[1] * a)};
}

class Ergun : public ::testing::TestWithParam<const char*> {};

TEST_P(Ergun, PressureDropAtFiveVelocities) {
  for (const auto model : {coupling::MomentumModel::a, coupling::MomentumModel::b})
    for (const double u : velocities) {
      const double exact = ergun_drop(u);
      const Drops drop = pressure_drop(u, GetParam(), model, 1);
      EXPECT_NEAR(drop.boundaries, exact, 0.01 * exact) << u << " m/s";
      // What the inlet pushes in beyond what leaves goes to the spheres: their share is the drop.
      EXPECT_NEAR(drop.on_spheres, exact, 0.01 * exact) << u << " m/s";
    }
}
INSTANTIATE_TEST_SUITE_P(Kernels, Ergun, ::testing::Values("centre", "trilinear", "smoothed"),
                         [](const auto& kernel) { return std::string(kernel.param); });

TEST(ErgunMutant, FivePercentMoreDragIsNoticed) {
  for (const double u : velocities) {
    const double exact = ergun_drop(u);
    const Drops drop = pressure_drop(u, "smoothed", coupling::MomentumModel::a, 1.05);
    EXPECT_GT(std::abs(drop.boundaries - exact), 0.01 * exact);
    EXPECT_GT(std::abs(drop.on_spheres - exact), 0.01 * exact);
  }
}

TEST(ErgunClosedForm, MatchesThePublishedDropAtTheBedOfTheSource) {
  // 15.6 mm of bed at 2 mm/s: 22.992 Pa in the source.
  EXPECT_NEAR(ergun_drop(0.002) / bed_length() * 15.6e-3, 22.992, 5e-3);
  EXPECT_NEAR(ergun_drop(0.020) / bed_length() * 15.6e-3, 230.507, 0.25);
}

} // namespace
