// SPDX-FileCopyrightText: 2026 The GranFlux developers
// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

#include "particles.hpp"

namespace granflux::particle_subset {

/// What a wall at rest does to frozen particles: evaluated once and given again as long as the
/// particle stays as it was. Springs do not stretch where nothing moves, so that what a contact
/// remembers stays, too.
class StandingContacts {
public:
  struct Contact {
    double radius = 0;                                             // m
    Vec3 position{std::numeric_limits<double>::quiet_NaN(), 0, 0}; // not a number: not known
    Vec3 force, torque;                                            // of all of its contacts, N, N m

    /// Whether particle i of `p` is at rest and was so, in the same place, when this was known.
    [[nodiscard]] bool holds(const Particles& p, int i) const {
      const Vec3& x = p.position[i];
      return (difference(x.x, position.x) | difference(x.y, position.y) |
              difference(x.z, position.z) | difference(p.radius[i], radius) | motion(p, i)) == 0;
    }
    void add_to(const Particles& p, int i) const {
      p.force[i] += force;
      p.torque[i] += torque;
    }
  };

  /// Forgets all; `rows` particles are near the wall. 0 holds no memory.
  void forget(std::size_t rows) {
    contacts_.clear();
    contacts_.shrink_to_fit();
    contacts_.resize(rows);
  }
  [[nodiscard]] std::size_t rows() const { return contacts_.size(); }

  /// That of particle i of `p`, in a row that no other thread asks for; `evaluate` adds force and
  /// torque to the particle and is called if they are not known. Returns whether they were.
  template <class Evaluate>
  bool add(std::size_t row, const Particles& p, int i, Evaluate&& evaluate) {
    Contact& known = contacts_[row];
    const bool holds = known.holds(p, i);
    if (!holds) {
      const Vec3 force = p.force[i], torque = p.torque[i];
      p.force[i] = p.torque[i] = {};
      evaluate();
      known = {.radius = p.radius[i], .position = {}, .force = p.force[i], .torque = p.torque[i]};
      known.position = motion(p, i) == 0 ? p.position[i] : Contact{}.position;
      p.force[i] = force, p.torque[i] = torque;
    }
    known.add_to(p, i);
    return holds;
  }
  [[nodiscard]] const Vec3& force(std::size_t row) const { return contacts_[row].force; }

private:
  // By bits: half the instructions of comparing numbers, and as exact.
  static std::uint64_t bits(double value) { return std::bit_cast<std::uint64_t>(value); }
  static std::uint64_t difference(double a, double b) { return bits(a) ^ bits(b); }
  /// 0: it is at rest.
  static std::uint64_t motion(const Particles& p, int i) {
    const Vec3 &v = p.velocity[i], &w = p.spin[i];
    constexpr int sign = 1; // of a zero
    return (bits(v.x) | bits(v.y) | bits(v.z) | bits(w.x) | bits(w.y) | bits(w.z)) << sign;
  }

  std::vector<Contact> contacts_;
};

} // namespace granflux::particle_subset
