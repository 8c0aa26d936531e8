// SPDX-FileCopyrightText: 2026 The GranFlux developers
// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

#include <span>
#include <vector>

namespace granflux::driver {

/// Some doubles of each particle of this rank, kept by a fix: the host tells the fix when particles
/// come, go and change places, and the fix tells its rows.
class ParticleRows {
public:
  /// `fresh`: the row of a new particle.
  explicit ParticleRows(std::vector<double> fresh) : fresh_(std::move(fresh)) {}

  [[nodiscard]] int columns() const { return int(fresh_.size()); }
  /// Room for n particles; the host asks before it fills more.
  void grow(int n);
  void copy(int from, int to);
  void set_fresh(int particle);
  /// Both return the number of doubles.
  int pack(int particle, double* buffer) const;
  int unpack(int particle, const double* buffer);

  /// As hosts take per-particle arrays; valid until the next grow().
  [[nodiscard]] double** pointers() { return pointers_.data(); }
  [[nodiscard]] double* data() { return values_.data(); }
  [[nodiscard]] const double* data() const { return values_.data(); }
  [[nodiscard]] double bytes() const;

  /// Of the first n particles; Row holds all columns.
  template <class Row> [[nodiscard]] std::span<Row> view(int n) {
    return {reinterpret_cast<Row*>(values_.data()), static_cast<std::size_t>(n)};
  }

private:
  [[nodiscard]] double* row(int particle);
  [[nodiscard]] const double* row(int particle) const;

  std::vector<double> fresh_, values_;
  std::vector<double*> pointers_;
};

} // namespace granflux::driver
