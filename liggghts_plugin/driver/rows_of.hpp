// SPDX-FileCopyrightText: 2026 The GranFlux developers
// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

#include <span>

namespace granflux::driver {

/// The rows of hosts' two-dimensional arrays are contiguous; without particles there is none.
template <class Row> std::span<Row> rows_of(double** array, std::size_t n) {
  return n ? std::span<Row>(reinterpret_cast<Row*>(array[0]), n) : std::span<Row>();
}

} // namespace granflux::driver
