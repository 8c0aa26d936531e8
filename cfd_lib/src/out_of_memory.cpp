// SPDX-FileCopyrightText: 2026 The GranFlux developers
// SPDX-License-Identifier: BSD-3-Clause
#include <granflux/cfd/out_of_memory.hpp>

#include <cstdio>

#include <sys/resource.h>

namespace granflux {

OutOfMemory::OutOfMemory(double wanted) noexcept {
  constexpr double mib = 1024.0 * 1024.0;
  rusage used{};
  getrusage(RUSAGE_SELF, &used);
  const double held = double(used.ru_maxrss) / 1024; // ru_maxrss is in KiB
  std::array<char, 48> more{};
  if (wanted > 0)
    std::snprintf(more.data(), more.size(), " and wants %.0f MiB more", wanted / mib);
  std::snprintf(
      text_.data(), text_.size(),
      "out of memory: this rank held up to %.0f MiB%s; fewer cells or particles, or ranks on "
      "more machines",
      held, more.data());
}

void explain_out_of_memory() {
  std::set_new_handler([] { throw OutOfMemory(); });
}

} // namespace granflux
