// SPDX-FileCopyrightText: 2026 The GranFlux developers
// SPDX-License-Identifier: GPL-2.0-or-later

#include "launch_options.hpp"

#include <charconv>
#include <cstdlib>
#include <string_view>

#include <fmt/core.h>
#include <omp.h>

#include <granflux/cfd/error.hpp>

namespace granflux::liggghts {

namespace {

constexpr int most_threads = 1024;

LaunchOptions options;

int number_of_threads(std::string_view origin, std::string_view word) {
  int threads = 0;
  const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), threads);
  if (error != std::errc() || end != word.data() + word.size() || threads < 1 ||
      threads > most_threads)
    throw ConfigError(fmt::format("{} is '{}': allowed is a whole number from 1 to {}", origin,
                                  word, most_threads));
  return threads;
}

bool switched_on(std::string_view option, std::string_view word) {
  if (word != "on" && word != "off")
    throw ConfigError(fmt::format("{} is '{}': allowed is on or off", option, word));
  return word == "on";
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

const LaunchOptions& launch_options() {
  return options;
}

void take_launch_options(int& argc, char** argv) {
  int threads = 0;
  int kept = 1;
  for (int i = 1; i < argc; ++i) {
    const std::string_view option = argv[i];
    if (option != "-threads" && option != "-subset") {
      argv[kept++] = argv[i];
      continue;
    }
    if (i + 1 == argc)
      throw ConfigError(fmt::format("{} needs a value", option));
    const std::string_view value = argv[++i];
    if (option == "-threads")
      threads = number_of_threads(option, value);
    else
      options.subset = switched_on(option, value);
  }
  argc = kept;
  argv[argc] = nullptr;
  omp_set_num_threads(threads > 0 ? threads : threads_of_environment());
}

} // namespace granflux::liggghts
