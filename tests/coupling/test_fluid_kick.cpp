// SPDX-FileCopyrightText: 2026 The GranFlux developers
// SPDX-License-Identifier: BSD-3-Clause

#include <cmath>
#include <gtest/gtest.h>

#include <granflux/coupling/fluid_kick.hpp>

namespace {

using namespace granflux;

TEST(DragResponse, IsExactFromNoDragToStiff) {
  EXPECT_EQ(coupling::drag_response(0).mean, 1);
  EXPECT_EQ(coupling::drag_response(0).lag, 0);
  for (double lambda = 1e-12; lambda < 1e6; lambda *= 1.07) {
    const long double x = lambda;
    // The lag by its series where 1 - exp(-x) has too few digits left, even as long double.
    const long double lag = lambda < 1e-3
                                ? -x / 2 + x * x / 6 - x * x * x / 24 + x * x * x * x / 120
                                : -std::expm1(-x) / x - 1;
    const auto found = coupling::drag_response(lambda);
    EXPECT_NEAR(found.mean, double(lag + 1), 4e-16) << lambda;
    EXPECT_NEAR(found.lag / double(lag), 1, 1e-14) << lambda;
  }
}

TEST(ExactDrag, EndsWhereTheEquationOfMotionDoes) {
  // m dv/dt = b (u - v) + f from v0: v = u + f/b + (v0 - u - f/b) exp(-b t/m).
  const double m = 2e-6, dt = 1e-3;
  const Vec3 u{1, -2, 0.5}, v0{0.1, 0.3, -4}, f{3e-5, 0, -2e-5};
  for (const double lambda : {1e-3, 0.1, 1., 10., 100.}) {
    const double b = lambda * m / dt;
    const Vec3 end = u + f / b + std::exp(-lambda) * (v0 - u - f / b);
    const Vec3 kicked = v0 + dt / m * (coupling::exact_drag(b, lambda, u, v0, f) + f);
    EXPECT_LT(norm(kicked - end), 1e-13 * (norm(end) + norm(v0) + norm(f / b))) << lambda;
  }
}

TEST(ExactDrag, OfAHeldParticleIsThatOfItsVelocity) {
  const Vec3 drag = coupling::exact_drag(3, 0, {1, 0, 0}, {0.25, 0, 0}, {1e3, 0, 0});
  EXPECT_EQ(drag, (Vec3{2.25, 0, 0}));
}

TEST(EffectiveCoefficient, TakesAFreeParticleToItsSlip) {
  // Over a long interval a free particle can take no more than its own momentum change.
  EXPECT_NEAR(coupling::effective_coefficient(5, 5e6), 1e-6, 1e-18);
  EXPECT_NEAR(coupling::effective_coefficient(5, 5e-12), 5, 1e-10);
}

} // namespace
