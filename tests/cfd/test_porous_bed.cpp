// SPDX-FileCopyrightText: 2026 The GranFlux developers
// SPDX-License-Identifier: BSD-3-Clause

// Gas pushed through fixed drag: dp/dz = -beta U / eps^2 (model A: -eps dp/dz = beta u, u = U/eps),
// however stiff beta is, and across a jump to empty gas.
#include <gtest/gtest.h>

#include "box_case.hpp"

using namespace granflux;
using namespace granflux::cfd;
using namespace granflux::cfd::testing;

namespace {

struct Bed {
  double beta, eps, superficial, dt;
};

double pressure_drop(const Bed& bed, bool model_b = false) {
  GasCase c = box_case({4, 4, 32}, {0.1, 0.1, 1}, {true, true, false});
  c.fluid.density = 1.2;
  c.fluid.viscosity = 1.8e-5;
  boundary(c, "z_low").kind = BoundaryKind::inlet;
  boundary(c, "z_low").velocity = {0, 0, bed.superficial};
  boundary(c, "z_high").kind = BoundaryKind::outlet;
  const Mesh mesh = make_mesh(c, MPI_COMM_WORLD);
  GasSolver gas(mesh, c);
  BlockFields eps = make_fields(mesh, bed.eps);
  MomentumExchange exchange = make_exchange(mesh);
  for_each_cell(mesh, [&](std::size_t b, std::ptrdiff_t p, const Vec3& x) {
    exchange.drag_coefficient[b][p] = x.z < 0.5 ? bed.beta : 0;
    exchange.pressure_fraction[b][p] = model_b ? 1 : bed.eps;
  });
  gas.initialise(eps, {0, 0, bed.superficial / bed.eps});
  for (int s = 0; s < 20; ++s) {
    const StepReport report = gas.advance(bed.dt, eps, &exchange);
    EXPECT_LT(report.continuity_residual, 1e-11 * report.continuity_scale);
  }
  EXPECT_NEAR(gas.boundary_flux("z_high"), 0.01 * bed.superficial, 1e-12 * bed.superficial);
  EXPECT_LT(norm(gas.balance().momentum_residual), 1e-12 * gas.balance().momentum_scale);
  return gas.boundary_pressure("z_low") - gas.boundary_pressure("z_high");
}

TEST(PorousBed, PressureDropIsExact) {
  for (const Bed bed : {Bed{3e3, 0.42, 0.6, 1e-4}, Bed{3e5, 0.45, 0.02, 1e-4},
                        Bed{2e6, 0.5, 0.02, 1e-1}, Bed{1e-3, 0.99, 1, 1e-3}}) {
    const double expected = 0.5 * bed.beta * bed.superficial / (bed.eps * bed.eps);
    EXPECT_NEAR(pressure_drop(bed), expected, 1e-8 * expected) << bed.beta;
    EXPECT_NEAR(pressure_drop(bed, true), expected * bed.eps, 1e-8 * expected) << bed.beta;
  }
}

} // namespace
