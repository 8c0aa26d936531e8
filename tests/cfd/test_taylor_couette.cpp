// SPDX-FileCopyrightText: 2026 The GranFlux developers
// SPDX-License-Identifier: BSD-3-Clause

// Gap between a cylinder that turns and one at rest: u = A r + B / r, T = ln(r / R2) / ln(R1 / R2).
#include <gtest/gtest.h>

#include <granflux/cfd/annulus_grid.hpp>
#include <granflux/cfd/split_blocks.hpp>

#include "box_case.hpp"

using namespace granflux;
using namespace granflux::cfd;
using namespace granflux::cfd::testing;

namespace {

constexpr double inner = 1, outer = 2, speed = 1; // m, rad/s

double exact_velocity(double r) {
  return -r / 3 + 4 / (3 * r);
}
double exact_temperature(double r) {
  return 300 + std::log(r / outer) / std::log(inner / outer);
}

struct Errors {
  double velocity, temperature, torque; ///< largest; largest; relative
};

Errors steady_errors(int n, TimeScheme scheme, double turning = speed) {
  AnnulusGrid annulus;
  annulus.inner_radius = inner, annulus.outer_radius = outer, annulus.length = 0.3;
  annulus.radial = n, annulus.tangential = 6 * n, annulus.axial = 1;
  annulus.periodic_axis = true;
  int ranks = 1;
  MPI_Comm_size(MPI_COMM_WORLD, &ranks);
  const Mesh mesh = make_mesh(split_for_ranks(make_annulus(annulus), ranks), MPI_COMM_WORLD);

  GasCase c;
  c.fluid.density = 1;
  c.fluid.viscosity = 1;
  c.energy = Energy{.heat_capacity = 1, .conductivity = 1, .initial_temperature = 300.5};
  BoundaryCondition wall;
  wall.name = "inner";
  wall.angular_velocity = {0, 0, turning};
  wall.heat = BoundaryCondition::Heat::temperature;
  wall.temperature = 301;
  c.boundaries.push_back(wall);
  wall.name = "outer";
  wall.angular_velocity = {};
  wall.temperature = 300;
  c.boundaries.push_back(wall);
  c.numerics.time_scheme = scheme;
  c.numerics.convection = ConvectionScheme::central;
  c.numerics.pressure_tolerance = 1e-8;
  GasSolver gas(mesh, c);
  gas.initialise(make_fields(mesh, 1), Vec3{});
  constexpr double dt = 0.02;
  for (int s = 0; s < int(1.6 / dt); ++s) // slowest mode: e^(-10 t)
    gas.advance(dt, make_fields(mesh, 1), nullptr);

  double torque = 0; // about the axis, on the gas by its inner wall
  for (std::size_t b = 0; b < mesh.local.size(); ++b)
    for (const Patch& patch : mesh.info(mesh.local[b]).patches)
      if (!patch.link && mesh.boundaries[std::size_t(patch.boundary)] == "inner")
        for (int j = patch.cells.lo[1]; j < patch.cells.hi[1]; ++j) {
          const Block& block = mesh.local[b];
          const std::ptrdiff_t p = block.layout.at(0, j, 0), ghost = p - 1;
          const VectorField& u = gas.velocity()[b];
          const double x = block.centre[0][p], y = block.centre[1][p], r = std::hypot(x, y);
          const double g = c.fluid.viscosity * block.conductance[0][p];
          torque += inner * g * ((u[1][ghost] - u[1][p]) * x / r - (u[0][ghost] - u[0][p]) * y / r);
        }
  MPI_Allreduce(MPI_IN_PLACE, &torque, 1, MPI_DOUBLE, MPI_SUM, MPI_COMM_WORLD);
  // The two-point part holds mu du/dr; the stress mu r d(u/r)/dr has -mu u/r beside it.
  torque += 2 * pi * inner * inner * turning * c.fluid.viscosity * annulus.length;
  return {largest(mesh,
                  [&](std::size_t b, std::ptrdiff_t p, const Vec3& x) {
                    const double r = std::hypot(x.x, x.y), v = exact_velocity(r);
                    const VectorField& u = gas.velocity()[b];
                    return std::hypot(u[0][p] + v * x.y / r, u[1][p] - v * x.x / r);
                  }),
          largest(mesh,
                  [&](std::size_t b, std::ptrdiff_t p, const Vec3& x) {
                    return (*gas.temperature())[b][p] - exact_temperature(std::hypot(x.x, x.y));
                  }),
          torque / annulus.length / 16.755161 - 1};
}

TEST(TaylorCouette, SecondOrderOnTheAnnulus) {
  for (const TimeScheme scheme : {TimeScheme::semi_implicit, TimeScheme::implicit}) {
    const Errors coarse = steady_errors(8, scheme), fine = steady_errors(16, scheme);
    EXPECT_LT(fine.velocity, 3e-3);
    EXPECT_LT(fine.temperature, 1.6e-3);
    EXPECT_LT(std::abs(fine.torque), 1e-3);
    EXPECT_GT(std::log2(coarse.velocity / fine.velocity), 1.9);
    EXPECT_GT(std::log2(coarse.temperature / fine.temperature), 1.9);
    EXPECT_GT(std::log2(coarse.torque / fine.torque), 1.9);
  }
  EXPECT_GT(steady_errors(16, TimeScheme::semi_implicit, 1.05 * speed).velocity, 3e-3);
}

} // namespace
