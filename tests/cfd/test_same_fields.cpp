// SPDX-FileCopyrightText: 2026 The GranFlux developers
// SPDX-License-Identifier: BSD-3-Clause

// A drum of five blocks that turns, warms its gas and blows it through: the same fields whatever
// the blocks are cut into and however many ranks and threads share them; the same bits in every
// run.
#include <map>

#include <gtest/gtest.h>

#include <granflux/cfd/cylinder_grid.hpp>
#include <granflux/cfd/split_blocks.hpp>
#include <granflux/cfd/sweep.hpp>

#include "box_case.hpp"

using namespace granflux;
using namespace granflux::cfd;
using namespace granflux::cfd::testing;

namespace {

GasCase drum_case() {
  GasCase c;
  c.fluid.density = 1;
  c.fluid.viscosity = 0.01;
  c.fluid.gravity = {0, -9.81, 0};
  c.energy = Energy{.heat_capacity = 1,
                    .conductivity = 0.02,
                    .initial_temperature = 300,
                    .expansion = 0.003,
                    .reference_temperature = 300};
  c.numerics.pressure_tolerance = 1e-14;
  c.numerics.viscous_tolerance = 1e-15;
  BoundaryCondition wall;
  wall.name = "wall";
  wall.angular_velocity = {0, 0, 2};
  wall.heat = BoundaryCondition::Heat::temperature;
  wall.temperature = 373;
  BoundaryCondition low;
  low.name = "low";
  low.kind = BoundaryKind::inlet;
  low.velocity = {0, 0, 0.5};
  low.heat = BoundaryCondition::Heat::temperature;
  low.temperature = 300;
  BoundaryCondition high;
  high.name = "high";
  high.kind = BoundaryKind::outlet;
  high.temperature = 300;
  c.boundaries = {wall, low, high};
  return c;
}

Grid drum() {
  CylinderGrid cylinder;
  cylinder.radius = 0.5, cylinder.length = 0.8;
  cylinder.core = 6, cylinder.radial = 4, cylinder.axial = 8;
  return make_cylinder(cylinder);
}

struct Values {
  Vec3 velocity;
  double pressure, temperature;
};
/// By the centre of the cell, to a millionth of the radius.
using ByPlace = std::map<std::array<long, 3>, Values>;

ByPlace run(const Mesh& mesh) {
  GasSolver gas(mesh, drum_case());
  gas.initialise(make_fields(mesh, 1), Vec3{0, 0, 0.5});
  for (int s = 0; s < 5; ++s) {
    gas.advance(0.02, make_fields(mesh, 1), nullptr);
    const Balance& b = gas.balance();
    EXPECT_LT(norm(b.momentum_residual), 1e-11 * b.momentum_scale);
    EXPECT_LT(std::abs(b.heat_residual), 1e-11 * b.heat_scale);
    EXPECT_LT(std::abs(b.boundary_volume_flux + b.gas_volume_change), 1e-11 * 0.5);
  }
  ByPlace values;
  for_each_cell(mesh, [&](std::size_t b, std::ptrdiff_t p, const Vec3& x) {
    const VectorField& u = gas.velocity()[b];
    const auto place = [](double length) { return std::lround(length * 1e6); };
    values[{place(x.x), place(x.y), place(x.z)}] = {
        {u[0][p], u[1][p], u[2][p]}, gas.pressure()[b][p], (*gas.temperature())[b][p]};
  });
  return values;
}

/// Largest difference over the largest value.
double difference(const ByPlace& whole, const ByPlace& part) {
  double worst[3] = {0, 0, 0}, size[3] = {0, 0, 0};
  for (const auto& [place, v] : part) {
    const Values& w = whole.at(place);
    worst[0] = std::max(worst[0], norm(v.velocity - w.velocity));
    worst[1] = std::max(worst[1], std::abs(v.pressure - w.pressure));
    worst[2] = std::max(worst[2], std::abs(v.temperature - w.temperature));
  }
  for (const auto& [place, w] : whole) {
    size[0] = std::max(size[0], norm(w.velocity));
    size[1] = std::max(size[1], std::abs(w.pressure));
    size[2] = std::max(size[2], std::abs(w.temperature));
  }
  return std::max({worst[0] / size[0], worst[1] / size[1], worst[2] / size[2]});
}

TEST(SameFields, WhateverTheCutsRanksAndThreads) {
  const Grid grid = drum();
  const ByPlace whole = run(make_mesh(grid, MPI_COMM_SELF));
  for (const int pieces : {7, 12})
    EXPECT_LT(
        difference(whole, run(make_mesh(split_blocks(grid, choose_pieces(grid, pieces).value()),
                                        MPI_COMM_SELF))),
        1e-12)
        << pieces;
  int ranks = 1;
  MPI_Comm_size(MPI_COMM_WORLD, &ranks);
  const Mesh shared = make_mesh(split_for_ranks(grid, ranks), MPI_COMM_WORLD);
  const ByPlace first = run(shared);
  EXPECT_LT(difference(whole, first), 1e-12);
  EXPECT_EQ(difference(first, run(shared)), 0) << "not the same bits in two runs";
}

} // namespace
