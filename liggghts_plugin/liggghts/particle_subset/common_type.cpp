// SPDX-FileCopyrightText: 2026 The GranFlux developers
// SPDX-License-Identifier: GPL-2.0-or-later

#include "common_type.hpp"

#include <atomic>

#include "team.hpp"

namespace granflux::particle_subset {

int common_type(const int* type, int count) {
  if (count == 0)
    return 0;
  const int first = type[0];
  std::atomic<bool> others = false;
  for_each_subset(count, [&](Range range) {
    int different = 0;
    for (int p = range.begin; p < range.end; ++p)
      different |= type[p] ^ first;
    if (different)
      others.store(true, std::memory_order_relaxed);
  });
  return others ? 0 : first;
}

} // namespace granflux::particle_subset
