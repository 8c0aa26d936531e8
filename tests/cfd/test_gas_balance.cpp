// SPDX-FileCopyrightText: 2026 The GranFlux developers
// SPDX-License-Identifier: BSD-3-Clause

// Whatever the void fraction and the drag do: mass and momentum close, and the cut into blocks,
// ranks and threads does not show.
#include <gtest/gtest.h>

#include "box_case.hpp"

using namespace granflux;
using namespace granflux::cfd;
using namespace granflux::cfd::testing;

namespace {

GasCase rough_case(Index3 blocks) {
  GasCase c = box_case({8, 6, 16}, {0.08, 0.06, 0.2}, {false, true, false}, blocks);
  box_grid(c).nodes[2].clear();
  for (int i = 0; i <= 16; ++i)
    box_grid(c).nodes[2].push_back(0.2 * i / 16 * (1 + 0.3 * (1 - i / 16.0)));
  c.fluid = {.density = 1.2, .viscosity = 1.8e-5};
  boundary(c, "z_low").kind = BoundaryKind::inlet;
  boundary(c, "z_low").velocity = {0.1, 0, 0.8};
  boundary(c, "z_low").ramp_time = 0.002;
  boundary(c, "z_high").kind = BoundaryKind::outlet;
  boundary(c, "z_high").pressure = 3;
  boundary(c, "x_high").kind = BoundaryKind::slip;
  boundary(c, "x_low").velocity = {0, 0.2, 0.1};
  return c;
}

/// A lumpy bed that shakes.
double eps_at(const Vec3& x, double t) {
  if (x.z > 0.12)
    return 1;
  return 0.55 + 0.25 * std::sin(150 * x.x + 90 * x.z + 800 * t) * std::cos(110 * x.y + 20 * x.z);
}

struct ShakenBed {
  explicit ShakenBed(Index3 blocks, MPI_Comm comm)
      : gas_case(rough_case(blocks)), mesh(make_mesh(gas_case, comm)), gas(mesh, gas_case) {
    BlockFields eps = make_fields(mesh, 1);
    MomentumExchange exchange = make_exchange(mesh);
    for (int s = 0; s <= 25; ++s) {
      const double dt = s < 15 ? 2e-4 : 1e-4; // history must survive a change of step
      time += dt;
      for_each_cell(mesh, [&](std::size_t b, std::ptrdiff_t p, const Vec3& x) {
        eps[b][p] = eps_at(x, time);
        exchange.pressure_fraction[b][p] = eps[b][p];
        const double beta = 4e3 * std::pow(1 - eps[b][p], 2);
        exchange.drag_coefficient[b][p] = beta;
        exchange.drag_source[b][0][p] = beta * 0.1 * std::sin(30 * x.z);
        exchange.drag_source[b][2][p] = beta * 0.2;
      });
      if (s == 0) {
        gas.initialise(eps, {0, 0, 0.3});
        continue;
      }
      const StepReport report = gas.advance(dt, eps, &exchange);
      const Balance& balance = gas.balance();
      EXPECT_LT(report.continuity_residual, 1e-11 * report.continuity_scale);
      EXPECT_LT(std::abs(balance.gas_volume_change + balance.boundary_volume_flux),
                1e-12 * 0.0048 * report.continuity_scale);
      EXPECT_LT(norm(balance.momentum_residual), 1e-12 * balance.momentum_scale);
    }
  }
  double time = 0;
  GasCase gas_case;
  Mesh mesh;
  GasSolver gas;
};

TEST(GasBalance, ClosesAndDoesNotSeeBlocksRanksOrThreads) {
  const ShakenBed one({1, 1, 1}, MPI_COMM_SELF);
  for (const Index3 blocks : {Index3{0, 0, 0}, Index3{2, 3, 4}}) {
    const ShakenBed many(blocks, MPI_COMM_WORLD);
    // Compare cell by cell: find the single block's cell by its centre.
    const Lattice& lattice = *one.mesh.lattice;
    const auto cell = [&](const Vec3& x) {
      Index3 c;
      for (int d = 0; d < 3; ++d) {
        const auto& nodes = lattice.nodes[std::size_t(d)];
        c[std::size_t(d)] =
            int(std::upper_bound(nodes.begin(), nodes.end(), x[d]) - nodes.begin()) - 1;
      }
      return one.mesh.local[0].layout.at(c);
    };
    for (std::size_t m = 0; m < 3; ++m)
      EXPECT_LT(largest(many.mesh,
                        [&](std::size_t b, std::ptrdiff_t p, const Vec3& x) {
                          return many.gas.velocity()[b][m][p] - one.gas.velocity()[0][m][cell(x)];
                        }),
                1e-12);
    EXPECT_LT(largest(many.mesh,
                      [&](std::size_t b, std::ptrdiff_t p, const Vec3& x) {
                        return many.gas.pressure()[b][p] - one.gas.pressure()[0][cell(x)];
                      }),
              1e-9); // of some 1e2 Pa
  }
}

TEST(GasBalance, ClosedBoxRefusesANetFlux) {
  GasCase c = box_case({4, 4, 4}, {1, 1, 1}, {true, true, false});
  boundary(c, "z_low").kind = BoundaryKind::inlet;
  boundary(c, "z_low").velocity = {0, 0, 1};
  const Mesh mesh = make_mesh(c, MPI_COMM_WORLD);
  EXPECT_THROW(GasSolver(mesh, c), std::runtime_error);
}

} // namespace
