// SPDX-FileCopyrightText: 2026 The GranFlux developers
// SPDX-License-Identifier: GPL-2.0-or-later

#include "particle_rows.hpp"

#include <algorithm>

namespace granflux::driver {

double* ParticleRows::row(int particle) {
  return values_.data() + std::size_t(particle) * fresh_.size();
}

const double* ParticleRows::row(int particle) const {
  return values_.data() + std::size_t(particle) * fresh_.size();
}

void ParticleRows::grow(int n) {
  const std::size_t had = pointers_.size();
  if (std::size_t(n) <= had)
    return;
  values_.resize(std::size_t(n) * fresh_.size());
  pointers_.resize(std::size_t(n));
  for (int i = 0; i < n; ++i)
    pointers_[std::size_t(i)] = row(i);
  for (int i = int(had); i < n; ++i)
    set_fresh(i);
}

void ParticleRows::copy(int from, int to) {
  std::copy_n(row(from), fresh_.size(), row(to));
}

void ParticleRows::set_fresh(int particle) {
  std::ranges::copy(fresh_, row(particle));
}

int ParticleRows::pack(int particle, double* buffer) const {
  std::copy_n(row(particle), fresh_.size(), buffer);
  return columns();
}

int ParticleRows::unpack(int particle, const double* buffer) {
  std::copy_n(buffer, fresh_.size(), row(particle));
  return columns();
}

double ParticleRows::bytes() const {
  return double(values_.capacity() * sizeof(double) + pointers_.capacity() * sizeof(double*));
}

} // namespace granflux::driver
