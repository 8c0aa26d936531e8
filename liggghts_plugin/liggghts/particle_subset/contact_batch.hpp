// SPDX-FileCopyrightText: 2026 The GranFlux developers
// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

#include <array>
#include <bit>
#include <cstddef>

#include "contact_law.hpp"
#include "four.hpp"

namespace granflux::particle_subset {

/// Touching pairs side by side, an array per number, so that a law runs on vector registers. Small
/// enough to stay in the first-level cache.
struct ContactBatch {
  static constexpr int full = 48;     ///< pairs of a batch, but of the last one of a row of batches
  static constexpr int capacity = 64; ///< full ones and those that are found in one go
  static constexpr int lanes = 8;     ///< evaluated together: the widest vector register
  static_assert(full % lanes == 0 && capacity % lanes == 0);

  using Column = double[capacity];
  struct alignas(64) Vectors {
    Column x, y, z;
    [[nodiscard]] Vec3 at(int k) const { return {x[k], y[k], z[k]}; }
    void set(int k, const Vec3& v) { x[k] = v.x, y[k] = v.y, z[k] = v.z; }
    /// Of four pairs from k on, a multiple of four.
    void set_four(int k, FourRows& rows) {
      transpose(rows);
      put(rows[0], x + k), put(rows[1], y + k), put(rows[2], z + k);
    }
  };

  static void put(const Four& numbers, double* column) {
    *static_cast<Four*>(__builtin_assume_aligned(column, sizeof(Four))) = numbers;
  }
  /// As many pairs as are in the groups of lanes that hold `count`.
  [[nodiscard]] static int whole_groups(int count) { return (count + lanes - 1) / lanes * lanes; }

  // Which pair: numbers of the particles, entry in the rows it comes from.
  int i[capacity], j[capacity], entry[capacity];
  Four measured[capacity]; ///< as pairs are found: separation, distance squared
  Vectors separation;
  alignas(64) Column distance_squared;
  Vectors velocity, spin_i, spin_j;
  alignas(64) Column radius_i, radius_j, mass_i, mass_j;
  Vectors tangential_history, rolling_history;
  Vectors force, torque_i, torque_j;

  [[nodiscard]] TouchingPair pair(int k) const {
    return {separation.at(k), distance_squared[k], velocity.at(k), spin_i.at(k), spin_j.at(k),
            radius_i[k],      radius_j[k],         mass_i[k],      mass_j[k]};
  }
};

/// The constants of a law for each pair of a batch, an array per number. Where there is one
/// material they are the same for all and nothing is kept.
template <class Law, bool one_material> class BatchConstants {
public:
  using Constants = typename Law::Constants;
  explicit BatchConstants(const Constants& common) : common_(common) {}
  void set(int, const Constants&) {}
  [[nodiscard]] Constants at(int) const { return common_; }

private:
  Constants common_;
};

template <class Law> class BatchConstants<Law, false> {
public:
  using Constants = typename Law::Constants;
  static constexpr std::size_t numbers = sizeof(Constants) / sizeof(double);
  using Row = std::array<double, numbers>;
  static_assert(sizeof(Row) == sizeof(Constants), "the constants of a law must be doubles");

  explicit BatchConstants(const Constants&) {}
  void set(int k, const Constants& constants) {
    const Row row = std::bit_cast<Row>(constants);
    for (std::size_t n = 0; n < numbers; ++n)
      columns_[n][k] = row[n];
  }
  [[nodiscard]] Constants at(int k) const {
    Row row;
    for (std::size_t n = 0; n < numbers; ++n)
      row[n] = columns_[n][k];
    return std::bit_cast<Constants>(row);
  }

private:
  alignas(64) ContactBatch::Column columns_[numbers] = {};
};

/// Evaluates the first `count` pairs, rounded up to whole groups of lanes: each lane goes through
/// the same instructions, so that a pair's result does not depend on its place. `heat` takes what
/// the contacts make of it, if any.
template <class Law, bool one_material, class Heat>
[[gnu::flatten]] void evaluate(ContactBatch& b, int count,
                               const BatchConstants<Law, one_material>& constants, double dt,
                               Heat& heat) {
  const int whole = ContactBatch::whole_groups(count);
#pragma GCC ivdep
  for (int k = 0; k < whole; ++k) {
    Vec3 tangential = b.tangential_history.at(k), rolling = b.rolling_history.at(k);
    const ContactForce f = Law::force(constants.at(k), b.pair(k), dt, tangential, rolling);
    b.force.set(k, f.force);
    if constexpr (Law::turns) {
      b.torque_i.set(k, f.torque_i);
      b.torque_j.set(k, f.torque_j);
    }
    if constexpr (Law::has_tangential_history)
      b.tangential_history.set(k, tangential);
    if constexpr (Law::has_rolling_history)
      b.rolling_history.set(k, rolling);
    if constexpr (Heat::acts)
      heat.template set<Law>(k, f);
  }
}

} // namespace granflux::particle_subset
