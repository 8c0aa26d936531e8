// SPDX-FileCopyrightText: 2026 The GranFlux developers
// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>
#include <tuple>

#include <granflux/cfd/error.hpp>

#include "box_case.hpp"

using namespace granflux;
using namespace granflux::cfd;
using namespace granflux::cfd::testing;

namespace {

using Heat = BoundaryCondition::Heat;

void hold(GasCase& c, const std::string& name, double temperature) {
  boundary(c, name).heat = Heat::temperature;
  boundary(c, name).temperature = temperature;
}

BlockFields field(const Mesh& mesh, const std::function<double(const Vec3&)>& value) {
  BlockFields f = make_fields(mesh);
  for_each_cell(mesh, [&](std::size_t b, std::ptrdiff_t p, const Vec3& x) { f[b][p] = value(x); });
  return f;
}

TEST(Energy, LinearConductionIsExact) {
  GasCase c = box_case({6, 2, 4}, {1, 1, 1}, {false, true, false});
  box_grid(c).nodes[0] = {0, 0.1, 0.15, 0.4, 0.5, 0.8, 1};
  c.energy = Energy{.heat_capacity = 1, .conductivity = 0.3, .initial_temperature = 300};
  hold(c, "x_low", 400);
  hold(c, "x_high", 300);
  const Mesh mesh = make_mesh(c, MPI_COMM_WORLD);
  GasSolver gas(mesh, c);
  const auto linear = [](const Vec3& x) { return 400 - 100 * x.x; };
  const BlockFields eps = make_fields(mesh, 0.7);
  gas.initialise(eps, Vec3{});
  gas.set_temperature(field(mesh, linear));
  for (int s = 0; s < 10; ++s)
    gas.advance(0.1, eps, nullptr);
  EXPECT_LT(largest(mesh, [&](std::size_t b, std::ptrdiff_t p,
                              const Vec3& x) { return (*gas.temperature())[b][p] - linear(x); }),
            1e-10);
}

/// Wave of temperature that flows with the gas and fades: exp(-alpha k^2 t) sin(k (x - u t)).
double wave_error(int n, int steps, double conductivity) {
  constexpr double end = 0.5, speed = 1, k = 2 * pi, alpha = 0.02;
  GasCase c = box_case({n, 2, 2}, {1, 1, 1}, {true, true, true});
  c.energy = Energy{.heat_capacity = 2, .conductivity = 2 * conductivity, .initial_temperature = 0};
  c.numerics.convection = ConvectionScheme::central;
  const Mesh mesh = make_mesh(c, MPI_COMM_WORLD);
  GasSolver gas(mesh, c);
  const BlockFields one = make_fields(mesh, 1);
  gas.initialise(one, Vec3{speed, 0, 0});
  gas.set_temperature(field(mesh, [](const Vec3& x) { return std::sin(k * x.x); }));
  for (int s = 0; s < steps; ++s) {
    gas.advance(end / steps, one, nullptr);
    EXPECT_LT(std::abs(gas.balance().heat_residual), 1e-12 * gas.balance().heat_scale + 1e-13);
  }
  return largest(mesh, [&](std::size_t b, std::ptrdiff_t p, const Vec3& x) {
    return (*gas.temperature())[b][p] -
           std::exp(-alpha * k * k * end) * std::sin(k * (x.x - speed * end));
  });
}

TEST(Energy, SecondOrderInSpaceAndTime) {
  const double coarse = wave_error(32, 40, 0.02), fine = wave_error(64, 80, 0.02);
  EXPECT_LT(fine, 6e-3);
  EXPECT_GT(std::log2(coarse / fine), 1.9);
  EXPECT_GT(wave_error(64, 80, 0.05), 6e-3); // a wrong conductivity is seen
}

TEST(Energy, UniformTemperatureStaysUniformHoweverTheVoidFractionMoves) {
  GasCase c = box_case({8, 2, 8}, {1, 1, 1}, {false, true, false});
  boundary(c, "z_low").kind = BoundaryKind::inlet;
  boundary(c, "z_low").velocity = {0, 0, 1};
  boundary(c, "z_high").kind = BoundaryKind::outlet;
  hold(c, "z_low", 350);
  boundary(c, "z_high").temperature = 350;
  c.energy = Energy{.initial_temperature = 350};
  const Mesh mesh = make_mesh(c, MPI_COMM_WORLD);
  GasSolver gas(mesh, c);
  const auto eps = [&](int s) {
    return field(mesh, [&](const Vec3& x) {
      return 0.6 + 0.2 * std::sin(9 * x.x + 3 * s) * std::cos(11 * x.z - 2 * s);
    });
  };
  gas.initialise(eps(0), Vec3{});
  for (int s = 1; s < 15; ++s) {
    gas.advance(5e-3, eps(s), nullptr);
    EXPECT_LT(largest(mesh, [&](std::size_t b, std::ptrdiff_t p,
                                const Vec3&) { return (*gas.temperature())[b][p] - 350; }),
              350e-12 * s);
    EXPECT_LT(std::abs(gas.balance().heat_residual), 1e-11 * gas.balance().heat_scale);
  }
}

TEST(Energy, StiffExchangeMeetsTheOtherPhaseFromOneSide) {
  GasCase c = box_case({4, 4, 4}, {1, 1, 1}, {true, true, true});
  c.energy = Energy{.heat_capacity = 1000, .conductivity = 0, .initial_temperature = 300};
  const Mesh mesh = make_mesh(c, MPI_COMM_WORLD);
  GasSolver gas(mesh, c);
  const BlockFields eps = make_fields(mesh, 0.5);
  gas.initialise(eps, Vec3{});
  const double rate = 200, dt = 0.1; // of relaxation [1/s]
  const double coefficient = rate * 1000 * 0.5;
  const HeatExchange heat{make_fields(mesh, coefficient), make_fields(mesh, coefficient * 400)};
  double expected = 300;
  for (int s = 0; s < 3; ++s) {
    gas.advance(dt, eps, nullptr, &heat);
    expected = (expected + rate * dt * 400) / (1 + rate * dt);
    EXPECT_LT(largest(mesh, [&](std::size_t b, std::ptrdiff_t p,
                                const Vec3&) { return (*gas.temperature())[b][p] - expected; }),
              1e-9);
  }
}

TEST(Energy, GasThatFlowsBackHasTheTemperatureOfItsOutlet) {
  GasCase c = box_case({2, 2, 8}, {1, 1, 1}, {true, true, false});
  for (const auto& [name, pressure, temperature] :
       {std::tuple{"z_high", 0.0, 250.0}, std::tuple{"z_low", 5.0, 400.0}}) {
    boundary(c, name).kind = BoundaryKind::outlet;
    boundary(c, name).pressure = pressure;
    boundary(c, name).temperature = temperature;
  }
  c.energy = Energy{.heat_capacity = 1, .conductivity = 0, .initial_temperature = 300};
  const Mesh mesh = make_mesh(c, MPI_COMM_WORLD);
  GasSolver gas(mesh, c);
  const BlockFields one = make_fields(mesh, 1);
  for (int s = 0; s < 200; ++s) {
    gas.advance(0.01, one, nullptr);
    EXPECT_LT(std::abs(gas.balance().heat_residual), 1e-11 * gas.balance().heat_scale);
  }
  EXPECT_LT(gas.boundary_flux("z_low"), -1); // enters where the pressure is higher
  EXPECT_LT(largest(mesh, [&](std::size_t b, std::ptrdiff_t p,
                              const Vec3&) { return (*gas.temperature())[b][p] - 400; }),
            1);
}

TEST(Energy, WallHeatFluxHeatsTheGasByExactlyThat) {
  GasCase c = box_case({4, 2, 4}, {0.4, 0.1, 0.2}, {false, true, false});
  boundary(c, "x_low").heat = Heat::flux;
  boundary(c, "x_low").heat_flux = 50;
  c.energy = Energy{};
  const Mesh mesh = make_mesh(c, MPI_COMM_WORLD);
  GasSolver gas(mesh, c);
  const BlockFields one = make_fields(mesh, 1);
  for (int s = 0; s < 5; ++s)
    gas.advance(0.01, one, nullptr);
  EXPECT_NEAR(gas.balance().heat_conduction, 50 * 0.1 * 0.2, 1e-12);
  EXPECT_NEAR(gas.balance().heat_change, 50 * 0.1 * 0.2, 1e-9);
}

/// Square cavity of side 1, hot left, cold right, Prandtl number 0.71: mean Nusselt number.
double cavity_nusselt(double rayleigh, int n, double dt, int steps, double factor = 1) {
  GasCase c = box_case({n, 1, n}, {1, 1.0 / n, 1}, {false, true, false});
  hold(c, "x_low", 0.5);
  hold(c, "x_high", -0.5);
  c.numerics.convection = ConvectionScheme::central;
  c.fluid.viscosity = 0.71; // lengths in the side, times in L^2/alpha
  c.fluid.gravity = {0, 0, -1};
  c.energy = Energy{.heat_capacity = 1,
                    .conductivity = 1,
                    .initial_temperature = 0,
                    .expansion = rayleigh * 0.71 * factor,
                    .reference_temperature = 0};
  const Mesh mesh = make_mesh(c, MPI_COMM_WORLD);
  GasSolver gas(mesh, c);
  const BlockFields one = make_fields(mesh, 1);
  for (int s = 0; s < steps; ++s)
    gas.advance(dt, one, nullptr);
  // By symmetry all forces on the whole gas cancel: measure by those on half of it.
  EXPECT_LT(norm(gas.balance().momentum_residual), 1e-12 * rayleigh * 0.71);
  double heat = 0; // conducted into the gas at the hot wall
  for (std::size_t b = 0; b < mesh.local.size(); ++b) {
    const Layout& layout = mesh.local[b].layout;
    for (int k = 0; k < layout.cells[2]; ++k) {
      const std::ptrdiff_t p = layout.at(0, 0, k);
      if (mesh.local[b].node[0][p] == 0)
        heat += (0.5 - (*gas.temperature())[b][p]) * 2 / n; // k dT/(h/2) A, A = 1/n^2
    }
  }
  MPI_Allreduce(MPI_IN_PLACE, &heat, 1, MPI_DOUBLE, MPI_SUM, MPI_COMM_WORLD);
  return heat * n; // per depth 1/n
}

TEST(Energy, HeatedCavityNusseltNumber) {
  // Recomputed reference (Richardson from 80^2 and 160^2): 1.1178 and 2.2448.
  for (const auto& [rayleigh, reference, dt] :
       {std::array{1e3, 1.1178, 4e-3}, std::array{1e4, 2.2448, 1e-3}}) {
    const double coarse = cavity_nusselt(rayleigh, 16, dt, 300);
    const double fine = cavity_nusselt(rayleigh, 32, 0.5 * dt, 600);
    EXPECT_NEAR(fine, reference, 0.01 * reference);
    EXPECT_NEAR((4 * fine - coarse) / 3, reference, 0.003 * reference); // second order
  }
  // Buoyancy 5 % too strong is seen.
  EXPECT_GT(cavity_nusselt(1e4, 32, 5e-4, 600, 1.05), 1.01 * 2.2448);
}

TEST(Energy, NothingIsHeldWhereItIsNotAskedFor) {
  const GasCase c = box_case({4, 4, 4}, {1, 1, 1}, {true, true, true});
  const Mesh mesh = make_mesh(c, MPI_COMM_WORLD);
  GasSolver gas(mesh, c);
  EXPECT_EQ(gas.temperature(), nullptr);
  const HeatExchange heat{make_fields(mesh), make_fields(mesh)};
  EXPECT_THROW(gas.advance(1, make_fields(mesh, 1), nullptr, &heat), ConfigError);
}

} // namespace
