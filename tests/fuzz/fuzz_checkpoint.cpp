// SPDX-FileCopyrightText: 2026 The GranFlux developers
// SPDX-License-Identifier: BSD-3-Clause

// The checkpoint of granflux_cfd for the case that the corpus was written with: the damaged file,
// and where its checksum shows the damage the same numbers under a right one, so that they reach
// the gas.

#include <cstring>
#include <fstream>
#include <vector>

#include <mpi.h>

#include <granflux/cfd/case_mesh.hpp>
#include <granflux/cfd/checkpoint.hpp>
#include <granflux/cfd/error.hpp>
#include <granflux/cfd/gas_solver.hpp>
#include <granflux/cfd/read_gas_case.hpp>
#include <granflux/cfd/state_record.hpp>

#include "fuzz_target.hpp"

const bool granflux::testing::places_and_processes = false;

namespace {

using namespace granflux::cfd;

void write_under_right_checksum(const std::string& input, const std::string& file) {
  std::vector<double> numbers((input.size() - sizeof(RecordHeading)) / 8 - 1);
  std::memcpy(numbers.data(), input.data() + sizeof(RecordHeading), 8 * numbers.size());
  RecordHeading heading;
  std::memcpy(&heading, input.data(), sizeof heading);
  heading.kind.back() = '\0';
  std::ofstream out(file, std::ios::binary);
  RecordWriter record(heading.kind.data(), numbers.size(),
                      [&](const void* bytes, std::size_t count) {
                        out.write(static_cast<const char*>(bytes), std::streamsize(count));
                      });
  record.write(numbers);
  record.finish();
}

} // namespace

void granflux::testing::read_input(const std::string& input, const std::string& file) {
  const GasCase gas_case = read_gas_case(GRANFLUX_FUZZ_CASE, MPI_COMM_SELF);
  const Mesh mesh = make_mesh(gas_case, MPI_COMM_SELF);
  GasSolver gas(mesh, gas_case);
  gas.initialise(make_fields(mesh, 1.0), gas_case.initial_velocity);
  try {
    read_checkpoint(file, gas);
  } catch (const ConfigError&) {
    if (input.size() < sizeof(RecordHeading) + 8)
      throw;
    write_under_right_checksum(input, file);
    read_checkpoint(file, gas);
  }
}
