// SPDX-FileCopyrightText: 2026 The GranFlux developers
// SPDX-License-Identifier: GPL-2.0-or-later
#include "sealed_file.hpp"

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <string_view>
#include <system_error>
#include <unistd.h>
#include <vector>

#include <fmt/core.h>

#include <granflux/cfd/checksum.hpp>
#include <granflux/cfd/error.hpp>
#include <granflux/cfd/state_record.hpp>
#include <granflux/coupling/throw_together.hpp>

#include "checkpoint_options.hpp"

namespace granflux::driver {

namespace {

constexpr std::array<char, 16> seal_magic{"granflux sealed"};

struct Seal {
  std::array<char, 16> magic = seal_magic;
  std::uint64_t length = 0, checksum = 0;
};

/// LAMMPS looks for words of its own at the very end of the file: they are put there again.
constexpr std::size_t tail = 32;

/// The gas, in a file of the host that breaks off within it.
bool has_torn_record(std::string_view bytes) {
  const std::size_t start = bytes.find(cfd::record_magic);
  if (start == std::string_view::npos)
    return false;
  const std::string_view rest = bytes.substr(start);
  return rest.size() < sizeof(cfd::RecordHeading) ||
         cfd::RecordReader::bytes({rest.data(), rest.size()}) > rest.size();
}

/// In words; empty where nothing is wrong, or where it never was sealed: a host's own file.
std::string fault_of_sealed(const std::string& path) {
  const cfd::MappedFile file(path);
  const std::string_view bytes(file.data(), file.size());
  const std::string_view magic(seal_magic.data(), seal_magic.size());
  Seal seal;
  if (bytes.size() >= sizeof seal + tail)
    std::memcpy(&seal, bytes.data() + bytes.size() - tail - sizeof seal, sizeof seal);
  if (bytes.size() < sizeof seal + tail ||
      std::string_view(seal.magic.data(), seal.magic.size()) != magic) {
    // Checkpoints name the fix that wrote them, behind the gas.
    const bool ours = bytes.find(checkpoint_style) != std::string_view::npos ||
                      bytes.rfind(magic) != std::string_view::npos || has_torn_record(bytes);
    return ours ? "it is incomplete: the end is missing" : "";
  }
  if (seal.length != bytes.size() - sizeof seal - tail)
    return fmt::format("it is {} bytes long and should be {}", bytes.size(),
                       seal.length + sizeof seal + tail);
  cfd::Checksum sum;
  sum.add(bytes.data(), seal.length);
  return sum.value() == seal.checksum ? "" : "it is damaged: its checksum is another";
}

} // namespace

SealedFile::SealedFile(const std::string& path) : file_(path) {
  std::array<int, 2> ends{};
  if (pipe(ends.data()) != 0)
    throw std::system_error(errno, std::generic_category(), "a pipe for the checkpoint");
  read_end_ = ends[0], write_end_ = ends[1];
  pipe_path_ = fmt::format("/proc/self/fd/{}", write_end_);
  reader_ = std::thread([this] { drain(); });
}

SealedFile::~SealedFile() {
  if (reader_.joinable()) {
    close(write_end_);
    reader_.join();
  }
}

/// Until the host has closed the pipe. On a thread of its own; calls nothing of MPI.
void SealedFile::drain() {
  std::vector<char> buffer(std::size_t(1) << 20);
  std::array<char, tail> last{};
  Seal seal;
  cfd::Checksum sum;
  for (;;) {
    const ssize_t n = read(read_end_, buffer.data(), buffer.size());
    if (n < 0 && errno == EINTR)
      continue;
    if (n <= 0)
      break;
    const auto count = std::size_t(n);
    file_.write(buffer.data(), count);
    sum.add(buffer.data(), count);
    seal.length += count;
    const std::size_t kept = std::min(count, tail);
    std::move(last.begin() + std::ptrdiff_t(kept), last.end(), last.begin());
    std::copy_n(buffer.data() + count - kept, kept, last.end() - std::ptrdiff_t(kept));
  }
  close(read_end_);
  seal.checksum = sum.value();
  file_.write(&seal, sizeof seal);
  file_.write(last.data(), last.size());
}

bool SealedFile::finish() {
  close(write_end_);
  reader_.join();
  return file_.finish();
}

void check_restart_file(const std::string& path, MPI_Comm comm) {
  int rank = 0;
  MPI_Comm_rank(comm, &rank);
  std::string fault;
  if (rank == 0 && std::filesystem::exists(path)) // else the host says so, or has a pattern
    try {
      fault = fault_of_sealed(path);
    } catch (const ConfigError& e) {
      fault = e.what();
    }
  if (!fault.empty())
    fault = fmt::format("checkpoint {}: {}: use an earlier one", path, fault);
  coupling::throw_together<ConfigError>(comm, fault);
}

} // namespace granflux::driver
