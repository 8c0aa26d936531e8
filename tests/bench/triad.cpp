// SPDX-FileCopyrightText: 2026 The GranFlux developers
// SPDX-License-Identifier: BSD-3-Clause

// The machine's memory bandwidth in GB/s, as OMP_NUM_THREADS threads see it.

#include <cstdio>

#include "triad.hpp"

int main() {
  std::printf("%.2f\n", granflux::bench::triad());
}
