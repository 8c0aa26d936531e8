// SPDX-FileCopyrightText: 2026 The GranFlux developers
// SPDX-License-Identifier: BSD-3-Clause

// Hot gas breaks through a fixed cold bed: Schumann, J. Franklin Inst. 208 (1929) 405-416. With
//   y = h a x / (rho c U),  z = h a (t - eps x / U) / ((1 - eps) rho_s c_s)
// the temperatures, as shares of the step at the inlet, are
//   T_gas = J(y, z) = 1 - int_0^y exp(-z - s) I0(2 sqrt(z s)) ds,
//   T_solid = J(y, z) - exp(-y - z) I0(2 sqrt(y z)).

#include <cmath>
#include <gtest/gtest.h>
#include <numbers>

#include <granflux/cfd/sweep.hpp>

#include "warm_bed.hpp"

namespace {

using namespace granflux;

double gas_share(double y, double z) {
  constexpr int parts = 2000; // Simpson
  const auto f = [z](double s) {
    return std::exp(-z - s) * std::cyl_bessel_i(0, 2 * std::sqrt(z * s));
  };
  double sum = f(0) + f(y);
  for (int i = 1; i < parts; ++i)
    sum += (i % 2 ? 4 : 2) * f(y * i / parts);
  return 1 - sum * y / parts / 3;
}

double solid_share(double y, double z) {
  return gas_share(y, z) - std::exp(-y - z) * std::cyl_bessel_i(0, 2 * std::sqrt(y * z));
}

TEST(Schumann, ClosedFormMatchesThePublishedTable) {
  EXPECT_NEAR(gas_share(1, 1), 0.65425, 1e-5);
  EXPECT_NEAR(solid_share(1, 1), 0.34575, 1e-5);
  EXPECT_NEAR(gas_share(2, 5), 0.91393, 1e-5);
  EXPECT_NEAR(solid_share(5, 5), 0.43608, 1e-5);
  EXPECT_NEAR(gas_share(5, 10), 0.92561, 1e-5);
}

struct Errors {
  double gas = 0, solid = 0; ///< largest over the bed, of the step of temperature
};

/// A column of touching spheres on a lattice, one cell wide; the transfer length is 8 cells.
Errors breakthrough(double last_z, double coefficient_factor) {
  constexpr double d = 1e-3, eps = 0.4, u = 0.1, rho = 1.2, c = 1000, solid_heat = 24000;
  constexpr double cold = 300, hot = 400;
  constexpr int cells = 40, across = 2, along = 4; // spheres a cell
  const double a = d * std::cbrt(std::numbers::pi / 6 / (1 - eps)), dx = along * a;
  const double exchange = rho * c * u / (8 * dx); // h a
  const double h = exchange * d / (6 * (1 - eps));

  cfd::GasCase gas;
  box_grid(gas).nodes[0] = box_grid(gas).nodes[1] = cfd::uniform_nodes(0, across * a, 1);
  box_grid(gas).nodes[2] = cfd::uniform_nodes(0, cells * dx, cells);
  box_grid(gas).patches = {{"in", {2, false}},  {"out", {2, true}},    {"west", {0, false}},
                           {"east", {0, true}}, {"front", {1, false}}, {"back", {1, true}}};
  for (const char* side : {"west", "east", "front", "back"})
    gas.boundaries.push_back({.name = side, .kind = cfd::BoundaryKind::slip});
  gas.boundaries.push_back({.name = "in",
                            .kind = cfd::BoundaryKind::inlet,
                            .velocity = {0, 0, u},
                            .heat = cfd::BoundaryCondition::Heat::temperature,
                            .temperature = hot});
  gas.boundaries.push_back({.name = "out", .kind = cfd::BoundaryKind::outlet, .temperature = cold});
  gas.fluid = {.density = rho, .viscosity = 1.8e-5};
  gas.energy = cfd::Energy{.heat_capacity = c, .conductivity = 0, .initial_temperature = cold};
  gas.initial_velocity = {0, 0, u / eps};
  coupling::CouplingOptions options;
  options.void_fraction = "centre";
  options.heat_transfer_coefficient = coefficient_factor * h;
  coupling::Coupler coupler(gas, options, MPI_COMM_WORLD);
  granflux::testing::FakeHost host({0, 0, 0}, {across * a, across * a, cells * dx}, {},
                                   MPI_COMM_WORLD);
  host.slab_direction = 2;
  for (int k = 0; k < along * cells; ++k)
    for (int j = 0; j < across; ++j)
      for (int i = 0; i < across; ++i)
        host.add(granflux::testing::sphere((k * across + j) * across + i,
                                           {(i + 0.5) * a, (j + 0.5) * a, (k + 0.5) * a}, {}, d / 2,
                                           2000, true));
  granflux::testing::WarmBed bed(host, solid_heat / 2000, cold);
  coupler.initialise(bed.view(), 0);

  const double time = last_z * (1 - eps) * solid_heat / exchange;
  const int steps = int(std::ceil(time / (0.4 * dx * eps / u)));
  for (int step = 0; step < steps; ++step)
    bed.step(coupler, time / steps, 1);
  EXPECT_LT(coupler.report().heat_residual, 1e-12);

  Errors errors;
  const auto z_at = [&](double x) {
    return exchange * (time - eps * x / u) / ((1 - eps) * solid_heat);
  };
  const auto share = [&](double temperature) { return (temperature - cold) / (hot - cold); };
  for (std::size_t b = 0; b < coupler.mesh().local.size(); ++b) {
    const cfd::Block& block = coupler.mesh().local[b];
    cfd::for_cells(block.layout, [&](std::ptrdiff_t cell) {
      const double x = block.centre[2][cell];
      const double found = share((*coupler.gas().temperature())[b][cell]);
      const double exact = gas_share(exchange * x / (rho * c * u), z_at(x));
      errors.gas = std::max(errors.gas, std::abs(found - exact));
    });
  }
  for (std::size_t p = 0; p < host.size(); ++p) {
    // Spheres see the gas of their cell: its centre is where they belong.
    const double x = (std::floor(host.position[p].z / dx) + 0.5) * dx;
    const double exact = solid_share(exchange * x / (rho * c * u), z_at(x));
    errors.solid = std::max(errors.solid, std::abs(share(bed.temperature()[p]) - exact));
  }
  MPI_Allreduce(MPI_IN_PLACE, &errors, 2, MPI_DOUBLE, MPI_MAX, MPI_COMM_WORLD);
  return errors;
}

TEST(Schumann, Breakthrough) {
  for (const double z : {1., 2., 5.}) {
    const Errors errors = breakthrough(z, 1);
    EXPECT_LT(errors.gas, 0.02) << z;
    EXPECT_LT(errors.solid, 0.02) << z;
    RecordProperty("gas_error_z" + std::to_string(int(z)), std::to_string(errors.gas));
    std::printf("z = %g: gas %.4f, solid %.4f\n", z, errors.gas, errors.solid);
  }
}

TEST(Schumann, TenPercentMoreHeatTransferIsNoticed) {
  const Errors errors = breakthrough(2, 1.1);
  EXPECT_GT(std::max(errors.gas, errors.solid), 0.02);
}

} // namespace
