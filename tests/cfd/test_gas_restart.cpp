// SPDX-FileCopyrightText: 2026 The GranFlux developers
// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <granflux/cfd/error.hpp>

#include "box_case.hpp"
#include "saved_state.hpp"

using namespace granflux;
using namespace granflux::cfd;
using namespace granflux::cfd::testing;
using granflux::testing::load;
using granflux::testing::saved;

namespace {

TEST(GasRestart, ContinuesBitForBit) {
  GasCase c = box_case({6, 4, 8}, {1, 1, 1}, {false, true, false});
  boundary(c, "x_high").velocity = {0, 0, 1};
  const Mesh mesh = make_mesh(c, MPI_COMM_WORLD);
  GasSolver straight(mesh, c), stopped(mesh, c);
  BlockFields eps = make_fields(mesh, 0.8);
  const auto run = [&](GasSolver& gas, int from, int to) {
    for (int s = from; s < to; ++s) {
      for_each_cell(mesh, [&](std::size_t b, std::ptrdiff_t p, const Vec3& x) {
        eps[b][p] = 0.8 + 0.05 * std::sin(2 * pi * x.y + 0.3 * s);
      });
      gas.advance(0.01, eps, nullptr);
    }
  };
  straight.initialise(eps, Vec3{});
  run(straight, 0, 12);
  stopped.initialise(eps, Vec3{});
  for_each_cell(mesh, [&](std::size_t b, std::ptrdiff_t p, const Vec3&) { eps[b][p] = 0.8; });
  stopped.initialise(eps, Vec3{});
  run(stopped, 0, 5);
  GasSolver continued(mesh, c);
  load(continued, saved(stopped));
  run(continued, 5, 12);
  EXPECT_EQ(straight.time(), continued.time());
  EXPECT_EQ(saved(straight), saved(continued));
}

} // namespace
