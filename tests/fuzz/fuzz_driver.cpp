// SPDX-FileCopyrightText: 2026 The GranFlux developers
// SPDX-License-Identifier: BSD-3-Clause

// Feeds a reader with the files of a corpus and with mutations of them, the same ones for the same
// seed. A reader may take an input or refuse it with ConfigError; everything else ends the program:
// another exception, a crash, a leak, an input that takes too long. The input is left in
// `last_input`.
//
// Usage: fuzz_NAME CORPUS COUNT [SEED], or fuzz_NAME FILE to try one input.
// SHOW_REFUSALS=1 in the environment prints what the reader says.

#include <algorithm>
#include <chrono>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <random>
#include <string>
#include <sys/wait.h>
#include <unistd.h>
#include <vector>

#include <mpi.h>

#if defined(__SANITIZE_ADDRESS__)
#include <sanitizer/lsan_interface.h>
#endif

#include <granflux/cfd/error.hpp>

#include "fuzz_target.hpp"

namespace {

using Bytes = std::string;
using Random = std::mt19937_64;
constexpr unsigned longest_input = 20; // s

Bytes read_whole(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

std::vector<Bytes> corpus(const std::filesystem::path& path) {
  std::vector<std::filesystem::path> files;
  if (std::filesystem::is_directory(path))
    for (const auto& entry : std::filesystem::directory_iterator(path))
      files.push_back(entry.path());
  else
    files.push_back(path);
  std::ranges::sort(files);
  std::vector<Bytes> inputs;
  for (const auto& file : files)
    inputs.push_back(read_whole(file));
  return inputs;
}

std::size_t below(Random& random, std::size_t bound) {
  return std::uniform_int_distribution<std::size_t>(0, bound - 1)(random);
}

/// A run of bytes at a random place, mostly short.
std::pair<std::size_t, std::size_t> range_in(Random& random, const Bytes& bytes) {
  const std::size_t first = below(random, bytes.size());
  const std::size_t most = std::min<std::size_t>(bytes.size() - first, below(random, 8) ? 16 : 512);
  return {first, 1 + below(random, most)};
}

/// One to four changes: bits, bytes, numbers, pieces cut out, doubled or taken from another input.
Bytes mutated(Random& random, const std::vector<Bytes>& inputs) {
  static const std::vector<Bytes> words{"nan", "-1", "0", "1e308", "inf",        "[",
                                        "]",   "\"", "=", "{",     "2147483648", "\n",
                                        "[[",  ".",  ",", "true"};
  Bytes bytes = inputs[below(random, inputs.size())];
  for (std::size_t change = 1 + below(random, 4); change > 0 && !bytes.empty(); --change) {
    const auto [first, length] = range_in(random, bytes);
    switch (below(random, granflux::testing::places_and_processes ? 4 : 8)) {
    case 0:
      bytes[first] = char(bytes[first] ^ (1 << below(random, 8)));
      break;
    case 1:
      bytes[first] = char(below(random, 256));
      break;
    case 2: // the ends of the ranges of integers
      for (std::size_t i = first; i < std::min(first + 4, bytes.size()); ++i)
        bytes[i] = below(random, 2) ? char(0xff) : char(0x7f);
      break;
    case 3:
      std::fill_n(bytes.begin() + long(first), length, '\0');
      break;
    case 4:
      bytes.erase(first, length);
      break;
    case 5:
      bytes.insert(first, Bytes(bytes, first, length));
      break;
    case 6:
      bytes.insert(first, words[below(random, words.size())]);
      break;
    default: {
      const Bytes& other = inputs[below(random, inputs.size())];
      if (!other.empty()) {
        const auto [from, count] = range_in(random, other);
        bytes.replace(first, length, other, from, count);
      }
    }
    }
  }
  if (below(random, 32) == 0)
    bytes.resize(below(random, bytes.size() + 1));
  return bytes;
}

/// Whether the reader took it, in this process.
bool takes_here(const Bytes& input) {
  std::filesystem::remove("last_input"); // HDF5 may still hold the last one open
  std::ofstream("last_input", std::ios::binary) << input;
  alarm(longest_input); // ends the program
  try {
    granflux::testing::read_input(input, "last_input");
    alarm(0);
    return true;
  } catch (const granflux::ConfigError& refusal) {
    if (std::getenv("SHOW_REFUSALS"))
      std::puts(refusal.what());
    alarm(0);
    return false;
  }
}

bool takes(const Bytes& input) {
  if (!granflux::testing::places_and_processes)
    return takes_here(input);
  std::fflush(stdout);
  const pid_t child = fork();
  if (child == 0) {
    const int code = takes_here(input) ? 0 : 2;
    std::fflush(stdout);
    _exit(code);
  }
  int status = 0;
  waitpid(child, &status, 0);
  if (WIFEXITED(status) && (WEXITSTATUS(status) == 0 || WEXITSTATUS(status) == 2))
    return WEXITSTATUS(status) == 0;
  std::printf("see last_input\n");
  std::exit(1);
}

int run(const std::filesystem::path& path, std::size_t count, std::uint64_t seed) {
  const std::vector<Bytes> inputs = corpus(path);
  std::size_t taken = 0;
  for (const Bytes& input : inputs)
    taken += takes(input);
  if (taken == 0) {
    std::printf("no input of %s is taken\n", path.c_str());
    return 1;
  }
  Random random(seed);
  for (std::size_t i = 0; i < count; ++i)
    taken += takes(mutated(random, inputs));
  std::printf("%zu inputs and %zu mutations: %zu taken, the others refused\n", inputs.size(), count,
              taken);
  return 0;
}

} // namespace

int main(int argc, char** argv) {
  if (argc < 2)
    return 1;
#if defined(__SANITIZE_ADDRESS__)
  __lsan_disable(); // what MPI keeps
#endif
  MPI_Init(&argc, &argv);
#if defined(__SANITIZE_ADDRESS__)
  __lsan_enable();
#endif
  int code = run(argv[1], argc > 2 ? std::stoul(argv[2]) : 0, argc > 3 ? std::stoull(argv[3]) : 1);
#if defined(__SANITIZE_ADDRESS__)
  code = __lsan_do_recoverable_leak_check() != 0 ? 1 : code;
#endif
  MPI_Finalize();
  return code;
}
