// SPDX-FileCopyrightText: 2026 The GranFlux developers
// SPDX-License-Identifier: GPL-2.0-or-later

#include "couple_restart.hpp"

#include <cstring>
#include <limits>
#include <numeric>
#include <stdexcept>

#include <fmt/core.h>

#include <granflux/cfd/error.hpp>

namespace granflux::driver {

namespace {

/// Leading numbers of the block, all doubles; the lengths of the ranks' states follow, then these.
struct Header {
  double format = 1;
  double ranks = 0;
  double time_step = 0, steps_left = 0, owed = 0, next_fields_time = 0, fields_written = 0;
};
constexpr std::size_t header_doubles = sizeof(Header) / sizeof(double);

struct Ranks {
  explicit Ranks(MPI_Comm comm) {
    MPI_Comm_rank(comm, &rank);
    MPI_Comm_size(comm, &count);
  }
  int rank = 0, count = 1;
};

} // namespace

void write_couple_state(const CoupleState& state, std::FILE* file, MPI_Comm comm) {
  const Ranks ranks(comm);
  const auto length = (long long)(state.coupler.size());
  std::vector<long long> lengths(std::size_t(ranks.count));
  MPI_Allgather(&length, 1, MPI_LONG_LONG, lengths.data(), 1, MPI_LONG_LONG, comm);
  const long long total = std::accumulate(lengths.begin(), lengths.end(), 0LL);
  const auto bytes = (total + (long long)(lengths.size() + header_doubles)) * 8;
  if (bytes > std::numeric_limits<int>::max())
    throw ConfigError(
        fmt::format("the gas state is {} bytes long; a restart file takes {} from one "
                    "fix",
                    bytes, std::numeric_limits<int>::max()));

  std::vector<int> counts(lengths.begin(), lengths.end()), starts(lengths.size());
  std::exclusive_scan(counts.begin(), counts.end(), starts.begin(), 0);
  std::vector<double> all(ranks.rank == 0 ? std::size_t(total) : 0);
  MPI_Gatherv(state.coupler.data(), int(length), MPI_DOUBLE, all.data(), counts.data(),
              starts.data(), MPI_DOUBLE, 0, comm);
  if (ranks.rank != 0)
    return;

  const Header header{.ranks = double(ranks.count),
                      .time_step = state.time_step,
                      .steps_left = double(state.steps_left),
                      .owed = state.owed,
                      .next_fields_time = state.next_fields_time,
                      .fields_written = double(state.fields_written)};
  const std::vector<double> sizes(lengths.begin(), lengths.end());
  const int size = int(bytes);
  bool written = std::fwrite(&size, sizeof size, 1, file) == 1;
  written = std::fwrite(&header, sizeof header, 1, file) == 1 && written;
  written =
      std::fwrite(sizes.data(), sizeof(double), sizes.size(), file) == sizes.size() && written;
  written = std::fwrite(all.data(), sizeof(double), all.size(), file) == all.size() && written;
  if (!written)
    throw std::runtime_error("the restart file could not be written: is the disk full?");
}

CoupleState read_couple_state(const char* block, MPI_Comm comm) {
  const Ranks ranks(comm);
  Header header;
  std::memcpy(&header, block, sizeof header);
  if (header.format != Header{}.format)
    throw ConfigError(fmt::format("the restart file holds a gas state of format {}; this program "
                                  "reads format {}",
                                  header.format, Header{}.format));
  if (int(header.ranks) != ranks.count)
    throw ConfigError(fmt::format("the restart file was written by {} MPI ranks, this run has {}: "
                                  "the gas continues on the same number of ranks only",
                                  int(header.ranks), ranks.count));
  std::vector<double> sizes(std::size_t(ranks.count));
  const char* data = block + sizeof header;
  std::memcpy(sizes.data(), data, sizes.size() * sizeof(double));
  data += sizes.size() * sizeof(double);
  const auto before = std::size_t(std::accumulate(sizes.begin(), sizes.begin() + ranks.rank, 0.0));

  CoupleState state{.time_step = header.time_step,
                    .steps_left = long(header.steps_left),
                    .owed = header.owed,
                    .next_fields_time = header.next_fields_time,
                    .fields_written = long(header.fields_written),
                    .coupler = std::vector<double>(std::size_t(sizes[std::size_t(ranks.rank)]))};
  std::memcpy(state.coupler.data(), data + before * sizeof(double),
              state.coupler.size() * sizeof(double));
  return state;
}

} // namespace granflux::driver
