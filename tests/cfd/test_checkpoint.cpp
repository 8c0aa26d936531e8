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

#include "lively_gas.hpp"

using namespace granflux;
using namespace granflux::cfd;
using namespace granflux::cfd::testing;

namespace {

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
