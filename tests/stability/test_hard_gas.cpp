// SPDX-FileCopyrightText: 2026 The GranFlux developers
// SPDX-License-Identifier: BSD-3-Clause

// Gas alone where schemes give way: Reynolds numbers far beyond the grid, jumps of 1000 K, vortices
// that leave through an outlet, cells a hundred times longer than wide.

#include <algorithm>
#include <cmath>
#include <gtest/gtest.h>
#include <random>
#include <tuple>

#include <granflux/cfd/error.hpp>

#include "../cfd/box_case.hpp"

using namespace granflux;
using namespace granflux::cfd;
using namespace granflux::cfd::testing;

namespace {

constexpr double cold = 300, hot = 1300; // K

struct Extremes {
  double fastest = 0;          ///< m/s
  double below = 0, above = 0; ///< what temperatures are beyond cold and hot [K]
  double heat_error = 0;       ///< largest heat residual over its scale
  int pressure_iterations = 0;

  void include(GasSolver& gas) {
    fastest =
        std::max(fastest, largest(gas.mesh(), [&](std::size_t b, std::ptrdiff_t p, const Vec3&) {
                   const VectorField& u = gas.velocity()[b];
                   return norm({u[0][p], u[1][p], u[2][p]});
                 }));
    if (!gas.temperature())
      return;
    for_each_cell(gas.mesh(), [&](std::size_t b, std::ptrdiff_t p, const Vec3&) {
      below = std::max(below, cold - (*gas.temperature())[b][p]);
      above = std::max(above, (*gas.temperature())[b][p] - hot);
    });
    heat_error =
        std::max(heat_error, std::abs(gas.balance().heat_residual) / gas.balance().heat_scale);
  }
};

/// A hot jet at Re = 1e6 enters a cold box of 32 x 32 cells, which cannot resolve its sides.
Extremes jet(ConvectionScheme scheme) {
  constexpr int n = 32;
  constexpr double none = 1e300, low = 0.45, high = 0.65;
  GasCase c = box_case({n, 1, n}, {1, 1. / n, 1}, {false, true, false});
  for (BoxPatch& patch : box_grid(c).patches)
    if (patch.name == "x_low")
      patch.from.z = low, patch.to.z = high;
  box_grid(c).patches.push_back({"under", {0, false}, {-none, -none, -none}, {none, none, low}});
  box_grid(c).patches.push_back({"over", {0, false}, {-none, -none, high}, {none, none, none}});
  for (const char* name : {"under", "over"}) {
    c.boundaries.emplace_back();
    c.boundaries.back().name = name;
  }
  boundary(c, "x_low").kind = BoundaryKind::inlet;
  boundary(c, "x_low").velocity = {1, 0, 0};
  boundary(c, "x_low").heat = BoundaryCondition::Heat::temperature;
  boundary(c, "x_low").temperature = hot;
  boundary(c, "x_high").kind = BoundaryKind::outlet;
  boundary(c, "x_high").temperature = cold;
  c.fluid = {.density = 1, .viscosity = 1e-6};
  c.energy = Energy{.heat_capacity = 1000, .conductivity = 1e-3, .initial_temperature = cold};
  c.numerics.convection = scheme;
  const Mesh mesh = make_mesh(c, MPI_COMM_SELF);
  GasSolver gas(mesh, c);
  const BlockFields one = make_fields(mesh, 1);
  Extremes extremes;
  for (int step = 0; step < 600; ++step) { // it passes the box nearly three times
    EXPECT_LT(gas.advance(0.15 / n, one, nullptr).courant, 0.3);
    extremes.include(gas);
  }
  return extremes;
}

TEST(HardGas, JetAtReynoldsOneMillionIsBoundedByTheLimiterAlone) {
  const Extremes limited = jet(ConvectionScheme::limited);
  EXPECT_LT(limited.fastest, 1.4); // 1.2 at Re = 1000, where the grid is nearly enough
  EXPECT_LT(limited.below, 1e-6);
  EXPECT_LT(limited.above, 1e-6);
  EXPECT_LT(limited.heat_error, 1e-12);
  const Extremes central = jet(ConvectionScheme::central);
  EXPECT_GT(central.fastest, 1.05 * limited.fastest);
  EXPECT_GT(central.below, 100);
  EXPECT_GT(central.above, 100);
}

/// A hot stretch, carried once around a periodic row of 64 cells.
Extremes carried(ConvectionScheme scheme, double courant, TimeScheme time_scheme) {
  constexpr int n = 64;
  GasCase c = box_case({n, 1, 1}, {1, 1. / n, 1. / n}, {true, true, true});
  c.fluid = {.density = 1, .viscosity = 1e-3};
  c.energy = Energy{.heat_capacity = 1000, .conductivity = 0, .initial_temperature = cold};
  c.numerics.convection = scheme;
  c.numerics.time_scheme = time_scheme;
  const Mesh mesh = make_mesh(c, MPI_COMM_SELF);
  GasSolver gas(mesh, c);
  const BlockFields one = make_fields(mesh, 1);
  gas.initialise(one, Vec3{1, 0, 0});
  BlockFields temperature = make_fields(mesh);
  for_each_cell(mesh, [&](std::size_t b, std::ptrdiff_t p, const Vec3& x) {
    temperature[b][p] = x.x > 0.3 && x.x < 0.7 ? hot : cold;
  });
  gas.set_temperature(temperature);
  Extremes extremes;
  for (int step = 0; step < int(n / courant); ++step) {
    gas.advance(courant / n, one, nullptr);
    extremes.include(gas);
  }
  return extremes;
}

TEST(HardGas, JumpOf1000KIsCarriedWithinItsBounds) {
  for (const auto& [courant, scheme] :
       {std::pair{0.1, TimeScheme::semi_implicit}, std::pair{0.3, TimeScheme::semi_implicit},
        std::pair{0.9, TimeScheme::implicit}}) {
    const Extremes limited = carried(ConvectionScheme::limited, courant, scheme);
    EXPECT_LT(limited.below, 1e-6) << courant;
    EXPECT_LT(limited.above, 1e-6) << courant;
    EXPECT_LT(limited.heat_error, 1e-12) << courant;
  }
  EXPECT_GT(carried(ConvectionScheme::central, 0.1, TimeScheme::semi_implicit).below, 100);
  EXPECT_GT(carried(ConvectionScheme::upwind2, 0.1, TimeScheme::semi_implicit).below, 100);
}

// Stable is not monotone: at the scheme's limit of 0.5 there are overshoots of a few per cent.
TEST(HardGas, LimiterWithExplicitStepsNeedsSmallOnes) {
  const Extremes extremes = carried(ConvectionScheme::limited, 0.5, TimeScheme::semi_implicit);
  EXPECT_GT(extremes.above, 10);
  EXPECT_LT(extremes.above, 100);
}

/// Conduction in a box of 12 cells a side whose diffusion number is given: from one hot cell, or
/// from hot walls on two sides.
Extremes conducted(double number, bool walls, TimeScheme time_scheme) {
  constexpr int n = 12;
  GasCase c = box_case({n, n, n}, {1, 1, 1}, {!walls, true, true}, {1, 1, 1});
  constexpr double dt = 0.01;
  c.energy = Energy{.heat_capacity = 1000,
                    .conductivity = 1000 * number / (n * n * dt),
                    .initial_temperature = cold};
  c.numerics.time_scheme = time_scheme;
  for (BoundaryCondition& wall : c.boundaries)
    wall.heat = BoundaryCondition::Heat::temperature, wall.temperature = hot;
  const Mesh mesh = make_mesh(c, MPI_COMM_SELF);
  GasSolver gas(mesh, c);
  const BlockFields one = make_fields(mesh, 1);
  gas.initialise(one, Vec3{});
  if (!walls) {
    BlockFields temperature = make_fields(mesh, cold);
    temperature[0][mesh.local[0].layout.at(5, 6, 7)] = hot;
    gas.set_temperature(temperature);
  }
  Extremes extremes;
  for (int step = 0; step < 15; ++step) {
    gas.advance(dt, one, nullptr);
    extremes.include(gas);
  }
  if (!walls) {
    double mean = 0;
    for_each_cell(mesh, [&](std::size_t b, std::ptrdiff_t p, const Vec3&) {
      mean += (*gas.temperature())[b][p] / (n * n * n);
    });
    EXPECT_NEAR(mean, cold + (hot - cold) / (n * n * n), 1e-9) << number;
  }
  return extremes;
}

/// Largest temperature of the same hot cell, along one direction, by forward Euler or plain
/// Crank-Nicolson, which multiply its saw-tooth by 1 - 4 D and (1 - 2 D)/(1 + 2 D) a step.
double saw_tooth(double number, bool crank_nicolson, int steps) {
  const double factor = crank_nicolson ? (1 - 2 * number) / (1 + 2 * number) : 1 - 4 * number;
  return std::abs(std::pow(factor, steps));
}

TEST(HardGas, ConductionStaysWithinItsBoundsHoweverFast) {
  for (const double number : {0.1, 1., 10., 1000.})
    for (const bool walls : {false, true})
      for (const TimeScheme scheme : {TimeScheme::semi_implicit, TimeScheme::implicit}) {
        if (scheme == TimeScheme::implicit && number > 10)
          continue; // the same equation, solved less directly
        const Extremes extremes = conducted(number, walls, scheme);
        EXPECT_LT(extremes.below, 2e-3) << number << walls;
        EXPECT_LT(extremes.above, 2e-3) << number << walls;
        EXPECT_LT(extremes.heat_error, 1e-11) << number << walls;
      }
  EXPECT_GT(saw_tooth(10, false, 15), 1e20); // naive: explicit
  EXPECT_GT(saw_tooth(1000, true, 15), 0.9); // Crank-Nicolson damps no saw-tooth
}

/// A vortex faster than the flow is carried out through the outlet: gas flows back there.
TEST(HardGas, VortexLeavesThroughTheOutlet) {
  constexpr int n = 24;
  constexpr double strength = 5, radius = 0.12;
  GasCase c = box_case({2 * n, 1, n}, {2, 1. / n, 1}, {false, true, false});
  boundary(c, "x_low").kind = BoundaryKind::inlet;
  boundary(c, "x_low").velocity = {1, 0, 0};
  boundary(c, "x_high").kind = BoundaryKind::outlet;
  boundary(c, "z_low").kind = boundary(c, "z_high").kind = BoundaryKind::slip;
  c.fluid = {.density = 1, .viscosity = 1e-6};
  const Mesh mesh = make_mesh(c, MPI_COMM_SELF);
  GasSolver gas(mesh, c);
  const BlockFields one = make_fields(mesh, 1);
  BlockVectors u = make_vectors(mesh);
  for_each_cell(mesh, [&](std::size_t b, std::ptrdiff_t p, const Vec3& x) {
    const double rx = (x.x - 1.5) / radius, rz = (x.z - 0.5) / radius;
    const double turn = strength * std::exp(0.5 * (1 - rx * rx - rz * rz));
    u[b][0][p] = 1 - turn * rz;
    u[b][2][p] = turn * rx;
  });
  gas.initialise(one, u);
  Extremes start, way, end;
  start.include(gas);
  double back = 0;
  for (int step = 0; step < 1100; ++step) {
    gas.advance(0.25 / n / (1 + strength), one, nullptr);
    way.include(gas);
    for_each_cell(mesh, [&](std::size_t b, std::ptrdiff_t p, const Vec3& x) {
      if (x.x > 2 - 1. / n)
        back = std::min(back, gas.velocity()[b][0][p]);
    });
    EXPECT_LT(norm(gas.balance().momentum_residual), 1e-12 * gas.balance().momentum_scale);
  }
  end.include(gas);
  EXPECT_LT(back, -0.5); // there was backflow
  EXPECT_LT(way.fastest, 1.02 * start.fastest);
  EXPECT_LT(end.fastest, 1.2); // and it is over
}

/// Plane Poiseuille flow between plates across x, in cells `aspect` times longer than wide; largest
/// error over the middle velocity.
double channel_error(double aspect) {
  constexpr int n = 16;
  GasCase c = box_case({n, 4, 4}, {1, 4 * aspect / n, 4 * aspect / n}, {false, true, true});
  c.fluid = {.density = 1, .viscosity = 0.1, .driving_pressure_gradient = {0, 0, -0.8}};
  const Mesh mesh = make_mesh(c, MPI_COMM_SELF);
  GasSolver gas(mesh, c);
  const BlockFields one = make_fields(mesh, 1);
  for (int step = 0; step < 200; ++step)
    gas.advance(0.1, one, nullptr);
  return largest(mesh, [&](std::size_t b, std::ptrdiff_t p, const Vec3& x) {
    return gas.velocity()[b][2][p] - 4 * x.x * (1 - x.x);
  });
}

TEST(HardGas, CellsAHundredTimesLongerThanWide) {
  const double cubes = channel_error(1), needles = channel_error(100);
  EXPECT_LT(cubes, 5e-3); // 1/n^2
  EXPECT_NEAR(needles, cubes, 1e-6);

  for (const double aspect : {1., 100.}) { // noise, made solenoidal
    constexpr int n = 24;
    GasCase c = box_case({n, n, n}, {1, 1, aspect}, {true, true, true}, {1, 1, 1});
    c.fluid.viscosity = 1e-5;
    c.numerics.pressure_solver = PressureMethod::multigrid;
    const Mesh mesh = make_mesh(c, MPI_COMM_SELF);
    GasSolver gas(mesh, c);
    BlockVectors u = make_vectors(mesh);
    std::mt19937 random(5);
    std::uniform_real_distribution<double> noise(-1, 1);
    for_each_cell(mesh, [&](std::size_t b, std::ptrdiff_t p, const Vec3&) {
      for (std::size_t m = 0; m < 3; ++m)
        u[b][m][p] = noise(random) * (m == 2 ? aspect : 1);
    });
    const BlockFields one = make_fields(mesh, 1);
    gas.initialise(one, u);
    for (int step = 0; step < 5; ++step) {
      const StepReport report = gas.advance(0.1 / n, one, nullptr);
      EXPECT_LE(report.pressure_iterations, 12) << aspect;
      EXPECT_LT(report.continuity_residual, 1e-9 * report.continuity_scale) << aspect;
    }
  }
}

} // namespace
