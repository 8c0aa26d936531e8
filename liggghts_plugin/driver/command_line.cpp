// SPDX-FileCopyrightText: 2026 The GranFlux developers
// SPDX-License-Identifier: GPL-2.0-or-later

#include "command_line.hpp"

#include <charconv>
#include <cstdio>
#include <cstdlib>

#include <fmt/core.h>
#include <mpi.h>
#include <omp.h>

#include <granflux/cfd/error.hpp>
#include <granflux/version.hpp>

namespace granflux::driver {

namespace {

constexpr int most_threads = 1024;

int number_of_threads(std::string_view origin, std::string_view word) {
  int threads = 0;
  const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), threads);
  if (error != std::errc() || end != word.data() + word.size() || threads < 1 ||
      threads > most_threads)
    throw ConfigError(fmt::format("{} is '{}': allowed is a whole number from 1 to {}", origin,
                                  word, most_threads));
  return threads;
}

/// OMP_NUM_THREADS may hold a list, one number a level of nesting: the first counts.
int threads_of_environment() {
  const char* variable = std::getenv("OMP_NUM_THREADS");
  if (!variable)
    return 1;
  const std::string_view list = variable;
  return number_of_threads("OMP_NUM_THREADS", list.substr(0, list.find(',')));
}

} // namespace

std::optional<std::string_view> take_option(int& argc, char** argv, std::string_view option) {
  std::optional<std::string_view> value;
  int kept = 1;
  for (int i = 1; i < argc; ++i) {
    if (argv[i] != option) {
      argv[kept++] = argv[i];
      continue;
    }
    if (i + 1 == argc)
      throw ConfigError(fmt::format("{} needs a value", option));
    value = argv[++i];
  }
  argc = kept;
  argv[argc] = nullptr;
  return value;
}

int take_threads(int& argc, char** argv) {
  const auto word = take_option(argc, argv, "-threads");
  const int threads = word ? number_of_threads("-threads", *word) : threads_of_environment();
  omp_set_num_threads(threads);
  return threads;
}

void print_version(std::string_view launcher, std::string_view host) {
  fmt::print("{} {}, revision {}\ncompiler: {}\nflags: {}\nhost: {}\n", launcher, version, revision,
             compiler, compiler_flags, host);
}

void refuse_to_start(const std::string& reason) {
  int rank = 0;
  MPI_Comm_rank(MPI_COMM_WORLD, &rank);
  if (rank == 0)
    fmt::print(stderr, "ERROR: {}\n", reason);
  MPI_Finalize();
}

} // namespace granflux::driver
