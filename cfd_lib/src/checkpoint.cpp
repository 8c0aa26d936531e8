// SPDX-FileCopyrightText: 2026 The GranFlux developers
// SPDX-License-Identifier: BSD-3-Clause
#include <granflux/cfd/checkpoint.hpp>

#include <algorithm>
#include <cstdint>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <fstream>

#include <granflux/cfd/error.hpp>

#include "throw_alike.hpp"

namespace granflux::cfd {

namespace {

constexpr char magic[] = "granflux gas checkpoint 1\n";
constexpr int tag = 73;

/// Fowler, Noll and Vo's hash 1a, by words: a torn or damaged file does not pass.
class Checksum {
public:
  void add(const void* bytes, std::size_t words) {
    const auto* from = static_cast<const char*>(bytes);
    for (std::size_t w = 0; w < words; ++w) {
      std::uint64_t word = 0;
      std::memcpy(&word, from + 8 * w, 8);
      hash_ = (hash_ ^ word) * 0x100000001b3u;
    }
  }
  [[nodiscard]] std::uint64_t value() const { return hash_; }

private:
  std::uint64_t hash_ = 0xcbf29ce484222325u;
};

constexpr std::size_t longest_message = std::size_t(1) << 30; // MPI counts in int

void send(const std::vector<double>& values, int to, MPI_Comm comm) {
  const std::uint64_t size = values.size();
  MPI_Send(&size, 1, MPI_UINT64_T, to, tag, comm);
  for (std::size_t at = 0; at < size; at += longest_message)
    MPI_Send(values.data() + at, int(std::min(longest_message, values.size() - at)), MPI_DOUBLE, to,
             tag, comm);
}

std::vector<double> receive(int from, MPI_Comm comm) {
  std::uint64_t size = 0;
  MPI_Recv(&size, 1, MPI_UINT64_T, from, tag, comm, MPI_STATUS_IGNORE);
  std::vector<double> values(size);
  for (std::size_t at = 0; at < size; at += longest_message)
    MPI_Recv(values.data() + at, int(std::min(longest_message, values.size() - at)), MPI_DOUBLE,
             from, tag, comm, MPI_STATUS_IGNORE);
  return values;
}

/// What the state belongs to: blocks, their cells and ranks, whether there is a temperature.
std::vector<std::uint64_t> identity(const GasSolver& gas) {
  const Mesh& mesh = gas.mesh();
  std::vector<std::uint64_t> words{mesh.blocks.size(), gas.temperature() ? 1u : 0u};
  for (const BlockInfo& block : mesh.blocks) {
    words.push_back(std::uint64_t(block.rank));
    for (const int n : block.cells)
      words.push_back(std::uint64_t(n));
  }
  return words;
}

class Writer {
public:
  explicit Writer(const std::string& path) : file_(path, std::ios::binary) {
    file_.write(magic, sizeof magic - 1);
  }
  template <class Word> void write(const std::vector<Word>& words) {
    static_assert(sizeof(Word) == 8);
    const std::uint64_t size = words.size();
    put(&size, 1);
    put(words.data(), words.size());
  }
  bool close() {
    const std::uint64_t hash = sum_.value();
    file_.write(reinterpret_cast<const char*>(&hash), 8);
    file_.close();
    return bool(file_);
  }

private:
  void put(const void* words, std::size_t count) {
    file_.write(static_cast<const char*>(words), std::streamsize(8 * count));
    sum_.add(words, count);
  }
  std::ofstream file_;
  Checksum sum_;
};

class Reader {
public:
  explicit Reader(const std::string& path) : file_(path, std::ios::binary) {
    if (!file_)
      throw ConfigError("checkpoint " + path + " cannot be read: no such file, or no permission");
    left_ = std::filesystem::file_size(path);
    char found[sizeof magic - 1];
    if (left_ < sizeof found || !file_.read(found, sizeof found) ||
        std::memcmp(found, magic, sizeof found) != 0)
      throw ConfigError("checkpoint " + path + " was not written by granflux_cfd of this version");
    left_ -= sizeof found;
  }
  template <class Word> std::vector<Word> read() {
    std::uint64_t size = 0;
    get(&size, 1);
    if (size > left_ / 8)
      torn();
    std::vector<Word> words(size);
    get(words.data(), size);
    return words;
  }
  void finish() {
    const std::uint64_t expected = sum_.value();
    std::uint64_t found = 0;
    get(&found, 1);
    if (found != expected || left_ != 0)
      torn();
  }

private:
  [[noreturn]] static void torn() {
    throw ConfigError("checkpoint: the file is incomplete or damaged; use an earlier one");
  }
  void get(void* words, std::size_t count) {
    if (8 * count > left_ || !file_.read(static_cast<char*>(words), std::streamsize(8 * count)))
      torn();
    left_ -= 8 * count;
    sum_.add(words, count);
  }
  std::ifstream file_;
  std::uintmax_t left_ = 0;
  Checksum sum_;
};

} // namespace

void write_checkpoint(const std::string& path, const GasSolver& gas,
                      const std::vector<double>& run) {
  const MPI_Comm comm = gas.mesh().comm;
  int rank = 0, ranks = 1;
  MPI_Comm_rank(comm, &rank);
  MPI_Comm_size(comm, &ranks);
  if (rank > 0) {
    send(gas.save(), 0, comm);
    throw_alike<NumericalError>(comm, "");
    return;
  }
  const std::string unfinished = path + ".part";
  Writer writer(unfinished);
  writer.write(identity(gas));
  writer.write(run);
  writer.write(gas.save());
  for (int from = 1; from < ranks; ++from)
    writer.write(receive(from, comm));
  const bool written = writer.close() && std::rename(unfinished.c_str(), path.c_str()) == 0;
  throw_alike<NumericalError>(comm, written ? ""
                                            : "checkpoint " + path +
                                                  " could not be written: no such folder, no "
                                                  "permission, or the disk is full");
}

std::vector<double> read_checkpoint(const std::string& path, GasSolver& gas) {
  const MPI_Comm comm = gas.mesh().comm;
  int rank = 0, ranks = 1;
  MPI_Comm_rank(comm, &rank);
  MPI_Comm_size(comm, &ranks);
  std::vector<double> run;
  std::vector<std::vector<double>> states;
  std::string error;
  if (rank == 0)
    try {
      Reader reader(path);
      if (reader.read<std::uint64_t>() != identity(gas))
        throw ConfigError("checkpoint " + path +
                          " belongs to another grid, other blocks or another number of ranks, or "
                          "to a case with other equations");
      run = reader.read<double>();
      for (int r = 0; r < ranks; ++r)
        states.push_back(reader.read<double>());
      reader.finish();
    } catch (const ConfigError& e) {
      error = e.what();
    }
  throw_alike(comm, error);
  int size = int(run.size());
  MPI_Bcast(&size, 1, MPI_INT, 0, comm);
  run.resize(std::size_t(size));
  MPI_Bcast(run.data(), size, MPI_DOUBLE, 0, comm);
  std::vector<double> mine;
  if (rank == 0) {
    for (int to = 1; to < ranks; ++to)
      send(states[std::size_t(to)], to, comm);
    mine = std::move(states[0]);
  } else {
    mine = receive(0, comm);
  }
  gas.load(mine);
  return run;
}

} // namespace granflux::cfd
