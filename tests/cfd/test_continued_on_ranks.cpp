// SPDX-FileCopyrightText: 2026 The GranFlux developers
// SPDX-License-Identifier: BSD-3-Clause

// A run that is continued on another number of ranks. For four of them.
#include <cstdio>

#include <gtest/gtest.h>

#include <granflux/cfd/case_mesh.hpp>
#include <granflux/cfd/checkpoint.hpp>

#include "lively_gas.hpp"

using namespace granflux;
using namespace granflux::cfd;
using namespace granflux::cfd::testing;

namespace {
/// The first so many ranks, or nothing on the others.
struct FirstRanks {
  explicit FirstRanks(int ranks) {
    MPI_Comm_split(MPI_COMM_WORLD, rank() < ranks ? 0 : MPI_UNDEFINED, 0, &comm);
  }
  ~FirstRanks() {
    if (comm != MPI_COMM_NULL)
      MPI_Comm_free(&comm);
  }
  FirstRanks(const FirstRanks&) = delete;
  FirstRanks& operator=(const FirstRanks&) = delete;
  MPI_Comm comm = MPI_COMM_NULL;
};

/// Runs of one case on so many ranks; the gas is made anew for each.
class Continued : public ::testing::TestWithParam<std::string> {
protected:
  Continued() {
    const std::string& grid = GetParam();
    if (grid == "box")
      gas_case_ = box_case({10, 9, 12}, {1, 1, 1}, {false, true, false});
    else
      gas_case_.grid =
          CylinderGrid{.frame = {}, .radius = 0.5, .length = 1, .core = 4, .radial = 3, .axial = 9};
    const GasCase lively = lively_case(TimeScheme::semi_implicit, 0);
    gas_case_.fluid = lively.fluid;
    gas_case_.energy = lively.energy;
    gas_case_.numerics = lively.numerics;
    gas_case_.numerics.pressure_tolerance = gas_case_.numerics.viscous_tolerance = 1e-13;
    if (grid != "box")
      for (const char* name : {"wall", "low", "high"})
        gas_case_.boundaries.push_back({.name = name});
    boundary(gas_case_, grid == "box" ? "z_high" : "high").kind = BoundaryKind::outlet;
  }

  /// From the checkpoint `from`, if any, through so many steps to the checkpoint `to`.
  void run(int ranks, const std::string& from, int steps, const std::string& to) const {
    const FirstRanks first(ranks);
    if (first.comm == MPI_COMM_NULL)
      return;
    const Mesh mesh = make_mesh(gas_case_, first.comm);
    GasSolver gas(mesh, gas_case_);
    if (from.empty())
      start(gas);
    else
      read_checkpoint(from, gas);
    BlockFields eps = make_fields(mesh, 0.8);
    for (int s = 0; s < steps; ++s) {
      for_each_cell(mesh, [&](std::size_t b, std::ptrdiff_t p, const Vec3& x) {
        eps[b][p] = 0.8 + 0.05 * std::sin(2 * pi * x.y + 3 * gas.time());
      });
      gas.advance(long(gas.steps()) % 2 ? 0.002 : 0.003, eps, nullptr);
    }
    write_checkpoint(to, gas, {});
  }

  /// Largest difference over the largest value, velocity and temperature, of two checkpoints.
  [[nodiscard]] std::pair<double, double> difference(const std::string& one,
                                                     const std::string& other) const {
    MPI_Barrier(MPI_COMM_WORLD);
    const Mesh mesh = make_mesh(gas_case_, MPI_COMM_SELF);
    GasSolver a(mesh, gas_case_), b(mesh, gas_case_);
    read_checkpoint(one, a);
    read_checkpoint(other, b);
    EXPECT_EQ(a.time(), b.time());
    double velocity = 0, fastest = 0, temperature = 0;
    for_each_cell(mesh, [&](std::size_t block, std::ptrdiff_t p, const Vec3&) {
      for (std::size_t m = 0; m < 3; ++m) {
        velocity =
            std::max(velocity, std::abs(a.velocity()[block][m][p] - b.velocity()[block][m][p]));
        fastest = std::max(fastest, std::abs(a.velocity()[block][m][p]));
      }
      temperature = std::max(temperature,
                             std::abs((*a.temperature())[block][p] - (*b.temperature())[block][p]));
    });
    MPI_Barrier(MPI_COMM_WORLD);
    EXPECT_GT(fastest, 0.1); // m/s
    return {velocity / fastest, temperature / 300};
  }

  GasCase gas_case_;
};

TEST_P(Continued, OnAnotherNumberOfRanks) {
  int ranks = 1;
  MPI_Comm_size(MPI_COMM_WORLD, &ranks);
  ASSERT_GE(ranks, 4);
  const int steps = 50;
  const std::string half = file_name("half"), same = file_name("same"), other = file_name("other");
  run(2, "", 7, half);
  MPI_Barrier(MPI_COMM_WORLD);
  run(2, half, steps, same);
  run(2, "", 7 + steps, other);
  EXPECT_EQ(difference(same, other), (std::pair{0.0, 0.0})) << "never stopped";
  for (const int to : {1, 4}) {
    run(to, half, steps, other);
    const auto [velocity, temperature] = difference(same, other);
    EXPECT_LT(velocity, 1e-10) << "on " << to;
    EXPECT_LT(temperature, 1e-11) << "on " << to;
    if (rank() == 0)
      std::printf("2 -> %d ranks: velocity %.1e, temperature %.1e\n", to, velocity, temperature);
  }
  run(1, "", 7, half);
  MPI_Barrier(MPI_COMM_WORLD);
  run(1, half, steps, same);
  run(2, half, steps, other);
  EXPECT_LT(difference(same, other).first, 1e-10) << "from 1 on 2";
}

INSTANTIATE_TEST_SUITE_P(Grids, Continued, ::testing::Values("box", "cylinder"),
                         [](const auto& test) { return test.param; });

} // namespace
