// SPDX-FileCopyrightText: 2026 The GranFlux developers
// SPDX-License-Identifier: GPL-2.0-or-later
#include "couple_restart.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <limits>
#include <stdexcept>

#include <fmt/core.h>

#include <granflux/cfd/error.hpp>
#include <granflux/cfd/state_record.hpp>

namespace granflux::driver {

namespace {

using cfd::RecordReader;
using cfd::RecordWriter;

constexpr char kind[] = "coupled gas";
using Numbers = std::array<double, sizeof(CoupleState) / sizeof(double)>;

bool is_first(MPI_Comm comm) {
  int rank = 0;
  MPI_Comm_rank(comm, &rank);
  return rank == 0;
}

/// Hosts' blocks; everything is written by rank 0.
class Block {
public:
  Block(std::FILE* file, std::uint64_t bytes) : file_(file) {
    const int size = int(bytes);
    put(&size, sizeof size);
  }
  void put(const void* bytes, std::size_t count) {
    good_ = std::fwrite(bytes, 1, count, file_) == count && good_;
  }
  void finish() const {
    if (!good_)
      throw std::runtime_error("the restart file could not be written: is the disk full?");
  }

private:
  std::FILE* file_;
  bool good_ = true;
};

} // namespace

void check_block_fits(const coupling::Coupler& coupler) {
  const std::uint64_t bytes =
      RecordWriter::bytes(std::tuple_size_v<Numbers> + coupler.saved_numbers());
  if (bytes > std::uint64_t(std::numeric_limits<int>::max()))
    throw ConfigError(fmt::format("the gas state is {} bytes long; a restart file takes {} from "
                                  "one fix: use fewer gas cells",
                                  bytes, std::numeric_limits<int>::max()));
}

void write_couple_state(const CoupleState& state, const coupling::Coupler& coupler, std::FILE* file,
                        MPI_Comm comm) {
  check_block_fits(coupler);
  const auto numbers = std::bit_cast<Numbers>(state);
  const std::uint64_t count = numbers.size() + coupler.saved_numbers();
  int finite = 1;
  if (is_first(comm)) {
    Block block(file, RecordWriter::bytes(count));
    RecordWriter out(kind, count, [&](const void* bytes, std::size_t n) { block.put(bytes, n); });
    out.write(numbers);
    coupler.save(&out);
    out.finish();
    block.finish();
    finite = out.finite();
  } else {
    coupler.save(nullptr);
  }
  MPI_Bcast(&finite, 1, MPI_INT, 0, comm);
  if (!finite)
    throw NumericalError("the gas holds a number that is not finite: nothing to continue from");
}

void write_couple_state(const std::optional<SavedCouple>& saved, std::FILE* file, MPI_Comm comm) {
  if (!is_first(comm))
    return;
  const std::vector<char> nothing;
  const std::vector<char>& record = saved ? saved->record : nothing;
  if (!record.empty()) {
    Block block(file, record.size());
    block.put(record.data(), record.size());
    return block.finish();
  }
  Block block(file, RecordWriter::bytes(0));
  RecordWriter out(kind, 0, [&](const void* bytes, std::size_t n) { block.put(bytes, n); });
  out.finish();
  block.finish();
}

std::optional<SavedCouple> read_couple_state(const char* block, MPI_Comm comm) {
  const std::uint64_t size = RecordReader::bytes({block, sizeof(cfd::RecordHeading)});
  RecordReader in(kind, {block, std::max<std::size_t>(size, sizeof(cfd::RecordHeading))});
  if (in.left() == 0)
    return {};
  Numbers numbers{};
  in.read(numbers);
  SavedCouple saved{.state = std::bit_cast<CoupleState>(numbers), .record = {}};
  if (is_first(comm))
    saved.record.assign(block, block + size);
  return saved;
}

void load(const SavedCouple& saved, coupling::Coupler& coupler) {
  if (!is_first(coupler.mesh().comm))
    return coupler.load(nullptr);
  RecordReader in(kind, saved.record);
  Numbers numbers{};
  in.read(numbers);
  coupler.load(&in);
}

} // namespace granflux::driver
