// SPDX-FileCopyrightText: 2026 The GranFlux developers
// SPDX-License-Identifier: BSD-3-Clause
#include <granflux/cfd/checkpoint.hpp>

#include <optional>

#include <granflux/cfd/error.hpp>
#include <granflux/cfd/whole_file.hpp>

#include "throw_alike.hpp"

namespace granflux::cfd {

namespace {

constexpr char kind[] = "gas";

bool is_first(MPI_Comm comm) {
  int rank = 0;
  MPI_Comm_rank(comm, &rank);
  return rank == 0;
}

} // namespace

void write_checkpoint(const std::string& path, const GasSolver& gas,
                      const std::vector<double>& run) {
  const MPI_Comm comm = gas.mesh().comm;
  const std::uint64_t numbers = 1 + run.size() + gas.saved_numbers();
  if (!is_first(comm)) {
    gas.save(nullptr);
    throw_alike<NumericalError>(comm, "");
    return;
  }
  WholeFile file(path);
  RecordWriter out(kind, numbers,
                   [&](const void* bytes, std::size_t count) { file.write(bytes, count); });
  out.write(double(run.size()));
  out.write(run);
  gas.save(&out);
  out.finish();
  std::string error;
  if (!out.finite())
    error = "checkpoint " + path + " is not written: the gas holds a number that is not finite";
  else if (!file.finish())
    error = "checkpoint " + file.failure() + "; what was there before is still whole";
  throw_alike<NumericalError>(comm, error);
}

std::vector<double> read_checkpoint(const std::string& path, GasSolver& gas) {
  const MPI_Comm comm = gas.mesh().comm;
  std::vector<double> run;
  std::optional<MappedFile> file;
  std::optional<RecordReader> in;
  std::string error;
  if (is_first(comm))
    try {
      file.emplace(path);
      in.emplace(kind, std::span(file->data(), file->size()));
      run.resize(in->read_count(in->left()));
      in->read(run);
    } catch (const ConfigError& e) {
      error = "checkpoint " + path + ": " + e.what();
    }
  throw_alike(comm, error);
  int size = int(run.size());
  MPI_Bcast(&size, 1, MPI_INT, 0, comm);
  run.resize(std::size_t(size));
  MPI_Bcast(run.data(), size, MPI_DOUBLE, 0, comm);
  try {
    gas.load(in ? &*in : nullptr);
  } catch (const ConfigError& e) { // on all ranks alike
    throw ConfigError("checkpoint " + path + ": " + e.what());
  }
  return run;
}

} // namespace granflux::cfd
