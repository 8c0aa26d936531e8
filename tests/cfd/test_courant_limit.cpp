// SPDX-FileCopyrightText: 2026 The GranFlux developers
// SPDX-License-Identifier: BSD-3-Clause

// The limits of the Courant number are those of the scheme: waves that a uniform flow carries do
// not grow up to them, and do beyond.
#include <gtest/gtest.h>

#include <random>

#include <granflux/cfd/courant_limit.hpp>

#include "box_case.hpp"

using namespace granflux;
using namespace granflux::cfd;
using namespace granflux::cfd::testing;

namespace {

/// Ratio by which the transverse velocity (rms), random from cell to cell at first, has changed
/// after `steps` steps of a uniform flow without friction worth naming.
double growth(ConvectionScheme convection, double courant, int steps) {
  constexpr int n = 48;
  GasCase gas_case = box_case({n, 2, 2}, {1, 0.1, 0.1}, {true, true, true}, {2, 1, 1});
  gas_case.fluid.viscosity = 1e-12;
  gas_case.numerics.convection = convection;
  const Mesh mesh = make_mesh(gas_case, MPI_COMM_WORLD);
  GasSolver gas(mesh, gas_case);
  std::mt19937 random(20);
  std::uniform_real_distribution<double> spread(-1, 1);
  std::array<double, n> wave;
  for (double& value : wave)
    value = 1e-3 * spread(random);
  BlockVectors velocity = make_vectors(mesh, {1, 0, 0});
  for_each_cell(mesh, [&](std::size_t b, std::ptrdiff_t c, const Vec3& x) {
    velocity[b][1][c] = wave[std::size_t(x.x * n)];
  });
  const BlockFields no_particles = make_fields(mesh, 1);
  gas.initialise(no_particles, velocity);
  const auto size = [&] {
    double squares = 0;
    for_each_cell(mesh, [&](std::size_t b, std::ptrdiff_t c, const Vec3&) {
      squares += gas.velocity()[b][1][c] * gas.velocity()[b][1][c];
    });
    MPI_Allreduce(MPI_IN_PLACE, &squares, 1, MPI_DOUBLE, MPI_SUM, mesh.comm);
    return std::sqrt(squares);
  };
  const double before = size();
  for (int step = 0; step < steps; ++step) {
    const StepReport report = gas.advance(courant / n, no_particles, nullptr);
    if (step == 0) {
      EXPECT_NEAR(report.courant, courant, 0.01 * courant);
    }
  }
  return size() / before;
}

double limit(ConvectionScheme convection) {
  Numerics numerics;
  numerics.convection = convection;
  return courant_limit(numerics);
}

} // namespace

// 4 % below and 10 % above: measured edges are between 0.25 and 0.28, and 0.50 and 0.55.
TEST(CourantLimit, WavesGrowBeyondItOnly) {
  for (const auto scheme : {ConvectionScheme::upwind2, ConvectionScheme::limited}) {
    EXPECT_LT(growth(scheme, 0.96 * limit(scheme), 400), 1);
    EXPECT_THROW(growth(scheme, 1.1 * limit(scheme), 400), NumericalError);
  }
}

// Central differences always grow a little without friction, by C^4/4 a step.
TEST(CourantLimit, CentralWavesGrowSlowlyUpToIt) {
  const double c = limit(ConvectionScheme::central);
  EXPECT_LT(growth(ConvectionScheme::central, c, 400), std::exp(400 * std::pow(c, 4) / 4));
  EXPECT_GT(growth(ConvectionScheme::central, 1.6 * c, 400), 100);
}

TEST(CourantLimit, ImplicitSchemeHasNone) {
  Numerics numerics;
  numerics.time_scheme = TimeScheme::implicit;
  EXPECT_EQ(courant_limit(numerics), Bound::none);
}

// The cell of the largest velocity, by its index and place, and the number that is beyond.
TEST(CourantLimit, HopelessStepNamesItsCell) {
  GasCase gas_case = box_case({4, 4, 8}, {0.1, 0.1, 0.2}, {true, true, false}, {1, 1, 2});
  boundary(gas_case, "z_low").kind = BoundaryKind::inlet;
  boundary(gas_case, "z_low").velocity = {0, 0, 5};
  boundary(gas_case, "z_high").kind = BoundaryKind::outlet;
  const Mesh mesh = make_mesh(gas_case, MPI_COMM_WORLD);
  GasSolver gas(mesh, gas_case);
  const double dt = 60 * 0.025 / 5; // 60 cells in a step
  try {
    gas.advance(dt, make_fields(mesh, 1), nullptr);
    FAIL() << "a Courant number of 60 was taken";
  } catch (const NumericalError& error) {
    const std::string text = error.what();
    for (const char* part : {"gas: step 1,", "Courant number 60", "cell (", "of block", "centre ("})
      EXPECT_NE(text.find(part), std::string::npos) << text;
  }
}
