// SPDX-FileCopyrightText: 2026 The GranFlux developers
// SPDX-License-Identifier: BSD-3-Clause

// Order in time alone: on one mesh, the change from a step to half of it falls by four. The mesh is
// fine, because the flux through a face remembers the old velocity of its cells, not its own, which
// leaves a term in dt h^2.
#include <gtest/gtest.h>

#include <granflux/cfd/sweep.hpp>

#include "box_case.hpp"
#include "skewed_square.hpp"

using namespace granflux;
using namespace granflux::cfd;
using namespace granflux::cfd::testing;

namespace {

struct State {
  BlockVectors velocity;
  BlockFields temperature;
};

/// Gas that heat lifts into motion while its void fraction begins to move. It starts from rest and
/// from equilibrium: the velocity lives in the middle of steps, the rest at their ends, and only a
/// state that does not change yet is the same at both.
State after(const Mesh& mesh, TimeScheme scheme, int steps) {
  constexpr double end = 0.8;
  GasCase c;
  c.fluid.density = 1;
  c.fluid.viscosity = 0.05;
  c.fluid.gravity = {0, -10, 0};
  c.energy = Energy{.heat_capacity = 1,
                    .conductivity = 0.05,
                    .initial_temperature = 300,
                    .expansion = 0.1,
                    .reference_temperature = 300};
  c.numerics.time_scheme = scheme;
  c.numerics.convection = ConvectionScheme::central;
  c.numerics.implicit_tolerance = 1e-9;
  c.numerics.pressure_corrections = 1;
  GasSolver gas(mesh, c);
  const auto field = [&](auto&& value) {
    BlockFields out = make_fields(mesh);
    for_each_cell(mesh,
                  [&](std::size_t b, std::ptrdiff_t p, const Vec3& x) { out[b][p] = value(x); });
    return out;
  };
  const auto mean = [&](auto&& value) {
    double sum = 0, volume = 0;
    for_each_cell(mesh, [&](std::size_t b, std::ptrdiff_t p, const Vec3& x) {
      sum += value(x) * mesh.local[b].volume[p], volume += mesh.local[b].volume[p];
    });
    return sum / volume;
  };
  const auto wave = [&](const Vec3& x, double t) {
    return t * t * t * std::sin(2 * pi * (x.x - t)) * std::cos(2 * pi * x.y);
  };
  const auto void_fraction = [&](double t) { // of constant mean: nothing leaves
    const double middle = mean([&](const Vec3& x) { return wave(x, t); });
    return field([&](const Vec3& x) { return 0.7 + 0.2 * (wave(x, t) - middle); });
  };
  const double dt = end / steps;
  gas.initialise(void_fraction(0), Vec3{});
  HeatExchange heat{make_fields(mesh), {}};
  State state;
  for (int s = 1; s <= steps + 1; ++s) {
    if (s == steps + 1)
      state = {gas.velocity(), *gas.temperature()};
    heat.source = field([&](const Vec3& x) {
      const double t = (s - 0.5) * dt;
      return 20 * t * t * std::sin(2 * pi * x.x);
    });
    gas.advance(dt, void_fraction(s * dt), nullptr, &heat);
  }
  // At `end` itself: the mean of the middles before and after it.
  for (std::size_t b = 0; b < mesh.local.size(); ++b)
    for (std::size_t m = 0; m < 3; ++m)
      for_cells(mesh.local[b].layout, [&](std::ptrdiff_t p) {
        state.velocity[b][m][p] = 0.5 * (state.velocity[b][m][p] + gas.velocity()[b][m][p]);
      });
  return state;
}

class TimeOrder : public ::testing::TestWithParam<std::tuple<bool, TimeScheme>> {};

TEST_P(TimeOrder, IsTwo) {
  const auto [skewed, scheme] = GetParam();
  const Mesh mesh =
      skewed ? make_mesh(skewed_square(20, 1), MPI_COMM_SELF)
             : make_mesh(box_case({40, 40, 1}, {1, 1, 0.1}, {true, true, true}), MPI_COMM_SELF);
  const State first = after(mesh, scheme, 20), second = after(mesh, scheme, 40),
              third = after(mesh, scheme, 80);
  const auto change = [&](const State& a, const State& b_) {
    std::array<double, 2> worst{};
    for_each_cell(mesh, [&](std::size_t b, std::ptrdiff_t p, const Vec3&) {
      for (std::size_t m = 0; m < 2; ++m)
        worst[0] = std::max(worst[0], std::abs(a.velocity[b][m][p] - b_.velocity[b][m][p]));
      worst[1] = std::max(worst[1], std::abs(a.temperature[b][p] - b_.temperature[b][p]));
    });
    return worst;
  };
  const auto coarse = change(first, second), fine = change(second, third);
  EXPECT_LT(fine[0], 1e-3);
  EXPECT_LT(fine[1], 2e-3);
  EXPECT_GT(std::log2(coarse[0] / fine[0]), 1.9);
  EXPECT_GT(std::log2(coarse[1] / fine[1]), 1.9);
}

INSTANTIATE_TEST_SUITE_P(Schemes, TimeOrder,
                         ::testing::Combine(::testing::Bool(),
                                            ::testing::Values(TimeScheme::semi_implicit,
                                                              TimeScheme::implicit)));

} // namespace
