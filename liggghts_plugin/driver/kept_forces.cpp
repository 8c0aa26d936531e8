// SPDX-FileCopyrightText: 2026 The GranFlux developers
// SPDX-License-Identifier: GPL-2.0-or-later
#include "kept_forces.hpp"

#include <algorithm>
#include <array>
#include <vector>

namespace granflux::driver {

namespace {

constexpr int columns = KeptForces::saved - 1; ///< whether there are any, force, torque

} // namespace

void KeptForces::expect(int n) {
  rows_.emplace(std::vector<double>(columns));
  rows_->grow(n);
}

int KeptForces::pack(const double* force, const double* torque, double* buffer) {
  std::fill_n(buffer, saved, 0);
  buffer[0] = saved;
  if (force) {
    buffer[1] = 1;
    std::copy_n(force, 3, buffer + 2);
    std::copy_n(torque, 3, buffer + 5);
  }
  return saved;
}

void KeptForces::restore(double** force, double** torque, int n) {
  const auto rows = rows_->view<std::array<double, columns>>(n);
  for (int i = 0; i < n; ++i) {
    const std::array<double, columns>& row = rows[std::size_t(i)];
    if (row[0] == 0)
      continue;
    std::copy_n(&row[1], 3, force[i]);
    std::copy_n(&row[4], 3, torque[i]);
  }
}

} // namespace granflux::driver
