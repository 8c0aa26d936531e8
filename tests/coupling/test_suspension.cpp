// SPDX-FileCopyrightText: 2026 The GranFlux developers
// SPDX-License-Identifier: BSD-3-Clause

// Particles that hang in an upflow at their terminal velocity: the net force on each is zero
// and the total pressure gradient bears the weight of the mixture, -(eps rho + (1-eps) rho_p) g.
// Buoyancy counted twice, or not at all, shows here at once.

#include <cmath>
#include <gtest/gtest.h>
#include <numbers>

#include <granflux/cfd/sweep.hpp>
#include <granflux/coupling/drag/wen_yu.hpp>

#include "fake_host.hpp"

namespace {

using namespace granflux;
using granflux::testing::FakeHost;
using granflux::testing::sphere;

constexpr double d = 1e-3, rho = 1000, mu = 1e-3, solid_density = 2500, g = 9.81, eps = 0.85;
constexpr int cells = 4, per_cell = 3;

/// Interstitial velocity at which drag, less the share of the pressure gradient (model A), bears
/// the weight less buoyancy: 3 pi mu d eps u F = eps (rho_p - rho) V g, by bisection.
double hovering_velocity() {
  const double wanted = eps * (solid_density - rho) * granflux::testing::sphere_volume(d / 2) * g;
  double low = 0, high = 1;
  for (int i = 0; i < 200; ++i) {
    const double u = 0.5 * (low + high);
    const double drag =
        3 * std::numbers::pi * mu * d * eps * u *
        coupling::WenYu{}({.reynolds = rho * eps * u * d / mu, .void_fraction = eps});
    (drag < wanted ? low : high) = u;
  }
  return 0.5 * (low + high);
}

class Suspension : public ::testing::TestWithParam<coupling::MomentumModel> {
protected:
  const double a = d * std::cbrt(std::numbers::pi / 6 / (1 - eps)), size = cells * per_cell * a;
  const double u = hovering_velocity();
  const double weight = solid_density * granflux::testing::sphere_volume(d / 2) * g;
  /// The solver carries the dynamic pressure; the total one has rho g besides.
  const double total_gradient = -(eps * rho + (1 - eps) * solid_density) * g;

  cfd::GasCase make_case() const {
    cfd::GasCase c;
    for (auto& nodes : box_grid(c).nodes)
      nodes = cfd::uniform_nodes(0, size, cells);
    box_grid(c).periodic = {true, true, true};
    c.fluid = {.density = rho, .viscosity = mu, .gravity = {0, 0, -g}};
    c.initial_velocity = {0, 0, u};
    c.numerics.pressure_tolerance = 1e-13;
    c.numerics.viscous_tolerance = 1e-13;
    return c;
  }
  static coupling::CouplingOptions options() {
    coupling::CouplingOptions o;
    o.drag = "wen_yu";
    o.void_fraction = "trilinear";
    o.model = GetParam();
    return o;
  }
  FakeHost make_host(const cfd::GasCase& c, bool fixed) const {
    FakeHost host({0, 0, 0}, {size, size, size}, box_grid(c).periodic, MPI_COMM_WORLD);
    host.gravity = {0, 0, -g};
    const int n = cells * per_cell;
    for (int p = 0; p < n * n * n; ++p)
      host.add(sphere(p, {(p % n + 0.5) * a, (p / n % n + 0.5) * a, (p / (n * n) + 0.5) * a}, {},
                      d / 2, solid_density, fixed));
    return host;
  }
};

TEST_P(Suspension, HeldInAnUpflowFeelsNoForceAndPressureBearsTheMixture) {
  cfd::GasCase c = make_case();
  box_grid(c).periodic[2] = false;
  box_grid(c).patches = {{"in", {2, false}}, {"out", {2, true}}};
  c.boundaries = {{.name = "in", .kind = cfd::BoundaryKind::inlet, .velocity = {0, 0, eps * u}},
                  {.name = "out", .kind = cfd::BoundaryKind::outlet}};
  coupling::Coupler coupler(c, options(), MPI_COMM_WORLD);
  FakeHost host = make_host(c, true);
  coupler.initialise(host.view(), 0);
  for (int step = 0; step < 40; ++step) // the gas forgets its start
    host.step(coupler, 1e-2, true, 1e-2);

  for (std::size_t p = 0; p < host.size(); ++p)
    EXPECT_LT(norm(host.force[p]), 1e-10 * weight);
  const cfd::Mesh& mesh = coupler.mesh();
  for (std::size_t b = 0; b < mesh.local.size(); ++b)
    cfd::for_cells(mesh.local[b].layout, [&](std::ptrdiff_t at) {
      EXPECT_NEAR(coupler.gas().pressure_gradient()[b][2][at] - rho * g, total_gradient,
                  1e-10 * std::abs(total_gradient));
    });
  const double drop =
      coupler.gas().boundary_pressure("in") - coupler.gas().boundary_pressure("out");
  EXPECT_NEAR(drop + rho * g * size, -total_gradient * size,
              1e-10 * std::abs(total_gradient * size));
}

TEST_P(Suspension, FreeUnderTheMixturesPressureGradientKeepsItsSlip) {
  // Free fall of both phases but for the pressure gradient that bears them: a common drift may be
  // left from the start, a force or a change of slip may not.
  cfd::GasCase c = make_case();
  c.fluid.driving_pressure_gradient = {0, 0, total_gradient + rho * g};
  coupling::Coupler coupler(c, options(), MPI_COMM_WORLD);
  FakeHost host = make_host(c, false);
  coupler.initialise(host.view(), 0);
  for (int step = 0; step < 400; ++step)
    host.step(coupler, 1e-3, step % 2 == 0, 2e-3);

  for (std::size_t p = 0; p < host.size(); ++p) {
    EXPECT_LT(norm(host.force[p]), 1e-9 * weight);
    EXPECT_NEAR(host.fluid[p].gas_velocity.z - host.velocity[p].z, u, 1e-9 * u);
    EXPECT_LT(std::abs(host.velocity[p].z), 0.01 * u);
  }
  EXPECT_LT(coupler.report().momentum_residual, 1e-12);
  EXPECT_LT(coupler.report().budget_residual, 1e-10);
}

INSTANTIATE_TEST_SUITE_P(Models, Suspension,
                         ::testing::Values(coupling::MomentumModel::a, coupling::MomentumModel::b),
                         [](const auto& model) {
                           return model.param == coupling::MomentumModel::a ? "A" : "B";
                         });

} // namespace
