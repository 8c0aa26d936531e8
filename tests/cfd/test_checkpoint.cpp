// SPDX-FileCopyrightText: 2026 The GranFlux developers
// SPDX-License-Identifier: BSD-3-Clause

// A run that is written to a file and continued from it is the run that went on.
#include <cstdio>
#include <filesystem>
#include <fstream>

#include <gtest/gtest.h>

#include <granflux/cfd/case_mesh.hpp>
#include <granflux/cfd/checkpoint.hpp>
#include <granflux/cfd/error.hpp>
#include <granflux/cfd/sweep.hpp>

#include "box_case.hpp"
#include "skewed_square.hpp"

using namespace granflux;
using namespace granflux::cfd;
using namespace granflux::cfd::testing;

namespace {

int rank() {
  int r = 0;
  MPI_Comm_rank(MPI_COMM_WORLD, &r);
  return r;
}

std::string file_name(const std::string& what) {
  int ranks = 1;
  MPI_Comm_size(MPI_COMM_WORLD, &ranks);
  return "checkpoint_" + what + "_" + std::to_string(ranks) + ".chk";
}

GasCase lively_case(TimeScheme scheme, double smagorinsky) {
  GasCase c;
  c.fluid.density = 1;
  c.fluid.viscosity = 0.02;
  c.fluid.smagorinsky = smagorinsky;
  c.fluid.gravity = {0, -9.81, 0};
  c.energy = Energy{.initial_temperature = 300, .expansion = 0.01, .reference_temperature = 300};
  c.numerics.time_scheme = scheme;
  return c;
}

void start(GasSolver& gas) {
  const Mesh& mesh = gas.mesh();
  BlockVectors u = make_vectors(mesh);
  BlockFields temperature = make_fields(mesh);
  for_each_cell(mesh, [&](std::size_t b, std::ptrdiff_t p, const Vec3& x) {
    u[b][0][p] = std::sin(2 * pi * x.y), u[b][1][p] = std::cos(2 * pi * x.x);
    temperature[b][p] = 300 + 20 * std::sin(2 * pi * x.x);
  });
  gas.initialise(make_fields(mesh, 1), u);
  gas.set_temperature(temperature);
}

TEST(Checkpoint, ContinuesBitForBit) {
  const Mesh mesh = make_mesh(skewed_square(6, 1, 2), MPI_COMM_WORLD);
  for (const TimeScheme scheme : {TimeScheme::semi_implicit, TimeScheme::implicit})
    for (const double smagorinsky : {0.0, 0.17}) {
      const GasCase c = lively_case(scheme, smagorinsky);
      const BlockFields one = make_fields(mesh, 1);
      GasSolver through(mesh, c), stopped(mesh, c), continued(mesh, c);
      start(through);
      start(stopped);
      const auto step = [](int s) { return s % 2 ? 0.01 : 0.013; };
      for (int s = 0; s < 3; ++s)
        through.advance(step(s), one, nullptr), stopped.advance(step(s), one, nullptr);
      write_checkpoint(file_name("same"), stopped, {1.25, 7});
      EXPECT_EQ(read_checkpoint(file_name("same"), continued), (std::vector<double>{1.25, 7}));
      EXPECT_EQ(continued.time(), through.time());
      for (int s = 3; s < 6; ++s)
        through.advance(step(s), one, nullptr), continued.advance(step(s), one, nullptr);
      for (std::size_t b = 0; b < mesh.local.size(); ++b)
        for_cells(mesh.local[b].layout, [&](std::ptrdiff_t p) {
          for (std::size_t m = 0; m < 3; ++m)
            ASSERT_EQ(through.velocity()[b][m][p], continued.velocity()[b][m][p]);
          ASSERT_EQ(through.pressure()[b][p], continued.pressure()[b][p]);
          ASSERT_EQ((*through.temperature())[b][p], (*continued.temperature())[b][p]);
        });
    }
}

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
  if (ranks < 4)
    GTEST_SKIP() << "needs 4 ranks";
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

TEST(Checkpoint, ForeignAndTornFilesAreRefused) {
  const Mesh mesh = make_mesh(skewed_square(4, 1), MPI_COMM_WORLD);
  GasSolver gas(mesh, lively_case(TimeScheme::semi_implicit, 0));
  const auto refusal = [&](const std::string& path, GasSolver& into) -> std::string {
    try {
      read_checkpoint(path, into);
    } catch (const ConfigError& error) {
      return error.what();
    }
    return "none";
  };
  EXPECT_NE(refusal("no_such.chk", gas).find("cannot be read"), std::string::npos);

  const std::string path = file_name("torn");
  write_checkpoint(path, gas, {});
  const Mesh other = make_mesh(skewed_square(5, 1), MPI_COMM_WORLD);
  GasSolver elsewhere(other, lively_case(TimeScheme::semi_implicit, 0));
  EXPECT_NE(refusal(path, elsewhere).find("another grid"), std::string::npos);

  MPI_Barrier(MPI_COMM_WORLD);
  if (rank() == 0) { // one bit
    std::fstream file(path, std::ios::in | std::ios::out | std::ios::binary);
    file.seekg(2000);
    const int byte = file.get();
    file.seekp(2000);
    file.put(char(byte ^ 1));
  }
  MPI_Barrier(MPI_COMM_WORLD);
  EXPECT_NE(refusal(path, gas).find("damaged"), std::string::npos);
  if (rank() == 0)
    std::filesystem::resize_file(path, 3000);
  MPI_Barrier(MPI_COMM_WORLD);
  EXPECT_NE(refusal(path, gas).find("damaged"), std::string::npos);
  if (rank() == 0)
    std::ofstream(path) << "something else";
  MPI_Barrier(MPI_COMM_WORLD);
  EXPECT_NE(refusal(path, gas).find("no state that GranFlux has written"), std::string::npos);

  EXPECT_THROW(write_checkpoint("no_such_folder/a.chk", gas, {}), NumericalError);
}

} // namespace
