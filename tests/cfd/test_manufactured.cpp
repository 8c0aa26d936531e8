// SPDX-FileCopyrightText: 2026 The GranFlux developers
// SPDX-License-Identifier: BSD-3-Clause

// A flow with everything in it, on skewed blocks that are turned against each other: viscosity,
// pressure, drag, and a void fraction that is uniform or a wave that grows and runs aslant. The
// source that makes it a solution is differentiated numerically, to 1e-7 of itself.
//
// eps = 1 - A + A g(t) sin(theta), theta = k.x - w t; continuity is met by
// eps u = Q + grad dpsi/dt with Q solenoidal and -laplacian psi = eps - (1 - A).
#include <gtest/gtest.h>

#include <granflux/cfd/split_blocks.hpp>

#include "box_case.hpp"
#include "skewed_square.hpp"

using namespace granflux;
using namespace granflux::cfd;
using namespace granflux::cfd::testing;

namespace {

constexpr double viscosity = 0.1, drag = 0.5;

struct Flow {
  double amplitude = 0; ///< A of the void fraction

  static constexpr double kx = 2, ky = -1, w = 3, square = kx * kx + ky * ky;

  /// The velocity of a step lives in its middle, the void fraction at its ends: both hold at the
  /// start only if nothing moves yet.
  static double growth(double t) { return t > 0 ? t * t * t / (t * t * t + 0.1) : 0; }
  static double growth_rate(double t) {
    const double cube = t > 0 ? t * t * t : 0, sum = cube + 0.1;
    return 0.3 * t * t / (sum * sum);
  }

  [[nodiscard]] double void_fraction(const Vec3& x, double t) const {
    return 1 - amplitude + amplitude * growth(t) * std::sin(kx * x.x + ky * x.y - w * t);
  }
  [[nodiscard]] Vec3 velocity(const Vec3& x, double t) const {
    const double theta = kx * x.x + ky * x.y - w * t;
    const double wave =
        amplitude / square *
        (growth_rate(std::max(t, 0.0)) * std::cos(theta) + w * growth(t) * std::sin(theta));
    const double faded = 1 - 0.5 * growth(t);
    const Vec3 superficial{0.5 - 0.6 * faded * std::sin(x.x) * std::sin(2 * x.y) + wave * kx,
                           0.3 - 0.3 * faded * std::cos(x.x) * std::cos(2 * x.y) + wave * ky, 0};
    return superficial / void_fraction(x, t);
  }
  [[nodiscard]] static double pressure(const Vec3& x, double t) {
    return 0.4 * std::cos(x.x + x.y) + 0.3 * std::sin(2 * x.x - x.y + t);
  }

  /// d(eps u)/dt + div(eps u u) + eps grad p - div(eps mu grad u): model A, density 1.
  [[nodiscard]] Vec3 source(const Vec3& x, double t) const {
    constexpr double h = 2e-4;
    const auto momentum = [&](double at) { return void_fraction(x, at) * velocity(x, at); };
    Vec3 sum = (1 / (2 * h)) * (momentum(t + h) - momentum(t - h));
    for (const Vec3& e : {Vec3{h, 0, 0}, Vec3{0, h, 0}}) {
      const auto carried = [&](const Vec3& at) {
        const Vec3 u = velocity(at, t);
        return void_fraction(at, t) * (dot(u, e) / h) * u;
      };
      sum += (1 / (2 * h)) * (carried(x + e) - carried(x - e));
      const double slope = (pressure(x + e, t) - pressure(x - e, t)) / (2 * h);
      sum += void_fraction(x, t) * slope / h * e;
      const Vec3 here = velocity(x, t);
      sum -= viscosity / (h * h) *
             (void_fraction(x + 0.5 * e, t) * (velocity(x + e, t) - here) -
              void_fraction(x - 0.5 * e, t) * (here - velocity(x - e, t)));
    }
    return sum;
  }
};

struct Errors {
  double velocity, pressure; ///< root mean square
};

Errors errors(const Flow& flow, int n, int steps, TimeScheme scheme, double factor = 1) {
  constexpr double end = 1;
  const double dt = end / steps;
  int ranks = 1;
  MPI_Comm_size(MPI_COMM_WORLD, &ranks);
  const Mesh mesh = make_mesh(split_for_ranks(skewed_square(n, 2 * pi), ranks), MPI_COMM_WORLD);
  GasCase c;
  c.fluid.density = 1;
  c.fluid.viscosity = factor * viscosity;
  c.numerics.convection = ConvectionScheme::central;
  c.numerics.time_scheme = scheme;
  GasSolver gas(mesh, c);
  const auto set_void_fraction = [&](BlockFields& field, double t) {
    double sums[2] = {0, 0}; // nothing leaves: the mean over the cells, too, must not change
    for_each_cell(mesh, [&](std::size_t b, std::ptrdiff_t p, const Vec3& x) {
      field[b][p] = flow.void_fraction(x, t);
      sums[0] += mesh.local[b].volume[p] * (1 - flow.amplitude - field[b][p]);
      sums[1] += mesh.local[b].volume[p];
    });
    MPI_Allreduce(MPI_IN_PLACE, sums, 2, MPI_DOUBLE, MPI_SUM, MPI_COMM_WORLD);
    for_each_cell(mesh, [&](std::size_t b, std::ptrdiff_t p, const Vec3&) {
      field[b][p] += sums[0] / sums[1];
    });
  };
  BlockFields eps = make_fields(mesh, 1);
  BlockVectors start = make_vectors(mesh);
  set_void_fraction(eps, 0);
  for_each_cell(mesh, [&](std::size_t b, std::ptrdiff_t p, const Vec3& x) {
    for (std::size_t m = 0; m < 3; ++m)
      start[b][m][p] = flow.velocity(x, -0.5 * dt)[int(m)];
  });
  gas.initialise(eps, start);
  MomentumExchange exchange = make_exchange(mesh);
  for (int s = 0; s < steps; ++s) {
    const double begin = s * dt; // of the step: where its momentum equation is centred
    set_void_fraction(exchange.pressure_fraction, begin);
    set_void_fraction(eps, begin + dt);
    for_each_cell(mesh, [&](std::size_t b, std::ptrdiff_t p, const Vec3& x) {
      const Vec3 force = flow.source(x, begin) + drag * flow.velocity(x, begin + 0.5 * dt);
      exchange.drag_coefficient[b][p] = drag;
      for (std::size_t m = 0; m < 3; ++m)
        exchange.drag_source[b][m][p] = force[int(m)];
    });
    const StepReport report = gas.advance(dt, eps, &exchange);
    EXPECT_LT(report.continuity_residual, 1e-8);
    EXPECT_FALSE(report.history_restarted);
  }
  double sums[4] = {0, 0, 0, 0}; // squares, volume, mean pressure error
  for_each_cell(mesh, [&](std::size_t b, std::ptrdiff_t p, const Vec3& x) {
    const double volume = mesh.local[b].volume[p];
    const VectorField& u = gas.velocity()[b];
    const Vec3 e = Vec3{u[0][p], u[1][p], u[2][p]} - flow.velocity(x, end - 0.5 * dt);
    const double q = gas.pressure()[b][p] - Flow::pressure(x, end - dt);
    sums[0] += volume * dot(e, e), sums[1] += volume * q * q;
    sums[2] += volume, sums[3] += volume * q;
  });
  MPI_Allreduce(MPI_IN_PLACE, sums, 4, MPI_DOUBLE, MPI_SUM, MPI_COMM_WORLD);
  const double mean = sums[3] / sums[2];
  return {std::sqrt(sums[0] / sums[2]), std::sqrt(sums[1] / sums[2] - mean * mean)};
}

class Manufactured : public ::testing::TestWithParam<TimeScheme> {};

void expect_second_order(const Flow& flow, TimeScheme scheme, const Errors& limit) {
  const Errors coarse = errors(flow, 12, 24, scheme), fine = errors(flow, 24, 48, scheme);
  EXPECT_LT(fine.velocity, limit.velocity);
  EXPECT_LT(fine.pressure, limit.pressure);
  EXPECT_GT(std::log2(coarse.velocity / fine.velocity), 1.9);
  EXPECT_GT(std::log2(coarse.pressure / fine.pressure), 1.9);
}

constexpr Flow plain{}, wave{.amplitude = 0.2};
constexpr Errors plain_limit{1.2e-3, 1.5e-3}, wave_limit{3e-3, 8e-3};

TEST_P(Manufactured, GasAloneIsSecondOrderInSpaceAndTime) {
  expect_second_order(plain, GetParam(), plain_limit);
}

TEST_P(Manufactured, VoidFractionInSpaceAndTimeIsSecondOrder) {
  expect_second_order(wave, GetParam(), wave_limit);
}

INSTANTIATE_TEST_SUITE_P(Schemes, Manufactured,
                         ::testing::Values(TimeScheme::semi_implicit, TimeScheme::implicit));

TEST(ManufacturedCanFail, SeesAFivePercentErrorInViscosity) {
  EXPECT_GT(errors(plain, 24, 48, TimeScheme::semi_implicit, 1.05).velocity, plain_limit.velocity);
  EXPECT_GT(errors(wave, 24, 48, TimeScheme::semi_implicit, 1.05).velocity, wave_limit.velocity);
}

} // namespace
