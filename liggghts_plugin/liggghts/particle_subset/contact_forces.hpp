// SPDX-FileCopyrightText: 2026 The GranFlux developers
// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

#include <algorithm>

#include "contact_batch.hpp"
#include "contact_lists.hpp"
#include "heat_batch.hpp"
#include "stored_at_parting.hpp"

namespace granflux::particle_subset {

/// The contact forces of one thread: goes along its rows, takes the pairs that touch and hands them
/// to the law in batches. Writes only what belongs to the particles of the range. Heat: a
/// HeatBatch, KeptWork, or WithoutHeat where there is none.
template <class Law, bool one_material, class Heat> class ContactForces {
public:
  using Constants = typename Law::Constants;

  /// `constants`: of each pair of the `types` types.
  ContactForces(const Particles& particles, ThreadContacts& contacts, const Constants* constants,
                int types, double dt, const typename Heat::Source& heat)
      : p_(particles), contacts_(contacts), constants_(constants), types_(types), dt_(dt),
        heat_(heat), own_(contacts.own), batch_constants_(of_pair(first_type(), first_type())) {
    if constexpr (Heat::acts) // of the one type, or of any: lanes without a pair must have some
      for (int k = 0; k < ContactBatch::capacity; ++k)
        heat_.set_constants(k, first_type(), first_type());
  }

  /// Along the lower rows, all of them.
  void add_lower() { add_rows<Side::lower>(contacts_.lower, own_); }
  /// Along the upper rows of some of the particles.
  void add_upper(Range particles) { add_rows<Side::upper>(contacts_.upper, particles); }

private:
  /// Which of a pair is the particle of the row: j of the lower rows, i of the upper.
  enum class Side { lower, upper };

  /// The type of all particles, where one is known.
  [[nodiscard]] int first_type() const { return std::max(p_.common_type, 1); }
  [[nodiscard]] const Constants& of_pair(int type_i, int type_j) const {
    return constants_[(type_i - 1) * types_ + type_j - 1];
  }

  template <Side side> void add_rows(ContactRows& rows, Range particles) {
    int count = 0;
    rows.for_each_run(particles.begin - own_.begin, particles.end - own_.begin,
                      [&](int first, int end) {
                        for (int e = first; e < end; e += stretch) {
                          count = measure<side>(rows, e, std::min(e + stretch, end), count);
                          if (count > ContactBatch::capacity - stretch) {
                            finish<side>(rows, count);
                            count = 0;
                          }
                        }
                      });
    finish<side>(rows, count);
  }

  /// Pairs that are measured in one go.
  static constexpr int stretch = 16;

  /// Puts those of the pairs first ... end - 1 that touch into the batch behind the `count` that it
  /// holds, and returns how many it holds then. Pair after pair, not row after row: the machine
  /// cannot foresee where rows end.
  template <Side side> int measure(const ContactRows& rows, int first, int end, int count) {
    const int last = int(rows.partner.size()) - 1;
    const int *const own = rows.particle.data(), *const partner = rows.partner.data();
    const double* const history = rows.history.data();
    const Particles p = p_; // in registers: what is written might else change it
    for (int e = first; e < end; ++e) {
      prefetch_place(p, partner[std::min(e + ahead, last)]);
      const int i = side == Side::upper ? own[e] : partner[e];
      const int j = side == Side::upper ? partner[e] : own[e];
      prefetch(p, partner[e]);
      if constexpr (Law::history > 0)
        __builtin_prefetch(history + std::ptrdiff_t(e) * Law::history, 1);
      const Vec3 separation = p.position[i] - p.position[j];
      const double squared = dot(separation, separation);
      const double radii = p.radius[i] + p.radius[j];
      batch_.i[count] = i;
      batch_.j[count] = j;
      batch_.entry[count] = e;
      batch_.separation.set(count, separation);
      batch_.distance_squared[count] = squared;
      if constexpr (Heat::template looks_at_partings<Law>)
        if (squared >= radii * radii && rows.flags[std::size_t(e)])
          part(rows, e, i, j);
      // Overwritten by the next pair unless this one touches.
      count += squared < radii * radii;
    }
    return count;
  }

  /// Entries from the fetching of a partner's place to its use: the time of a line from memory.
  static constexpr int ahead = 16;

  static void prefetch_place(const Particles& p, int partner) {
    __builtin_prefetch(p.position + partner);
    __builtin_prefetch(p.radius + partner);
  }

  /// What gather and scatter will want of a pair comes from far while other pairs are measured. Not
  /// what heat wants: its arrays are so dense that the machine fetches them ahead by itself, and
  /// fetching them here took a tenth of the loop.
  static void prefetch(const Particles& p, int partner) {
    __builtin_prefetch(p.velocity + partner);
    __builtin_prefetch(p.mass + partner);
    __builtin_prefetch(p.force + partner, 1);
    if constexpr (Law::turns) {
      __builtin_prefetch(p.spin + partner);
      __builtin_prefetch(p.torque + partner, 1);
    }
  }

  template <Side side> void finish(ContactRows& rows, int count) {
    if (count == 0)
      return;
    gather(rows, count);
    evaluate(batch_, count, batch_constants_, dt_, heat_);
    if constexpr (Heat::acts)
      heat_.add(batch_, count, own_);
    scatter<side>(rows, count);
    if constexpr (Heat::template resists<Law>)
      heat_.resist(batch_, count, own_);
  }

  /// A pair that has touched since the lists were built and does not now.
  void part(const ContactRows& rows, int e, int i, int j) {
    if (!heat_.all_dissipated())
      return;
    const Constants& k = of_pair(p_.type[i], p_.type[j]);
    const double* history = &rows.history[std::size_t(e) * Law::history];
    heat_.add_left(i, j, p_.type, left_at_parting<Law>(k, p_, i, j, dt_, history) / dt_, own_);
  }

  void gather(const ContactRows& rows, int count) {
    for (int k = 0; k < count; ++k) {
      const int i = batch_.i[k], j = batch_.j[k];
      batch_.velocity.set(k, p_.velocity[i] - p_.velocity[j]);
      if constexpr (Law::turns) {
        batch_.spin_i.set(k, p_.spin[i]);
        batch_.spin_j.set(k, p_.spin[j]);
      }
      batch_.radius_i[k] = p_.radius[i];
      batch_.radius_j[k] = p_.radius[j];
      batch_.mass_i[k] = p_.mass[i];
      batch_.mass_j[k] = p_.mass[j];
      if constexpr (!one_material) {
        batch_constants_.set(k, of_pair(p_.type[i], p_.type[j]));
        if constexpr (Heat::acts)
          heat_.set_constants(k, p_.type[i], p_.type[j]);
      }
      if constexpr (Law::history > 0)
        get_history(&rows.history[std::size_t(batch_.entry[k]) * Law::history], k);
      if constexpr (Heat::acts)
        heat_.gather(k, i, j);
    }
    if (p_.frozen_group)
      freeze(count);
    fill_up(count);
  }

  /// The reduced mass of a pair with a frozen particle is the mass of the other: m = 2m 2m / 4m.
  void freeze(int count) {
    for (int k = 0; k < count; ++k) {
      const double mass_i = batch_.mass_i[k], mass_j = batch_.mass_j[k];
      if (p_.groups[batch_.j[k]] & p_.frozen_group)
        batch_.mass_i[k] = batch_.mass_j[k] = 2 * mass_i;
      else if (p_.groups[batch_.i[k]] & p_.frozen_group)
        batch_.mass_i[k] = batch_.mass_j[k] = 2 * mass_j;
    }
  }

  /// The lanes of the last group that no pair is left for repeat the last pair.
  void fill_up(int count) {
    const int last = count - 1;
    for (int k = count; k % ContactBatch::lanes != 0; ++k) {
      const TouchingPair p = batch_.pair(last);
      batch_.separation.set(k, p.separation);
      batch_.distance_squared[k] = p.distance_squared;
      batch_.velocity.set(k, p.velocity);
      batch_.spin_i.set(k, p.spin_i);
      batch_.spin_j.set(k, p.spin_j);
      batch_.radius_i[k] = p.radius_i, batch_.radius_j[k] = p.radius_j;
      batch_.mass_i[k] = p.mass_i, batch_.mass_j[k] = p.mass_j;
      batch_constants_.set(k, batch_constants_.at(last));
      batch_.tangential_history.set(k, batch_.tangential_history.at(last));
      batch_.rolling_history.set(k, batch_.rolling_history.at(last));
    }
  }

  template <Side side> void scatter(ContactRows& rows, int count) {
    for (int k = 0; k < count; ++k) {
      if constexpr (side == Side::upper)
        add_to_i(k);
      if (side == Side::lower || own_.holds(batch_.j[k]))
        add_to_j(k);
      put_memory(rows, k);
    }
  }

  void add_to_i(int k) {
    const int i = batch_.i[k];
    p_.force[i] += batch_.force.at(k);
    if constexpr (Law::turns)
      p_.torque[i] += batch_.torque_i.at(k);
    if constexpr (Heat::acts)
      heat_.give_to_i(k, i);
  }

  void add_to_j(int k) {
    const int j = batch_.j[k];
    p_.force[j] -= batch_.force.at(k);
    if constexpr (Law::turns)
      p_.torque[j] += batch_.torque_j.at(k);
    if constexpr (Heat::acts)
      heat_.give_to_j(k, j);
  }

  void put_memory(ContactRows& rows, int k) const {
    if constexpr (Law::history > 0) {
      const auto e = std::size_t(batch_.entry[k]);
      if (rows.flags[e] != Law::touched) // mostly it is: the line stays clean
        rows.flags[e] = Law::touched;
      put_history(&rows.history[e * Law::history], k);
    }
  }

  static Vec3 vector_at(const double* h) { return {h[0], h[1], h[2]}; }
  static void set_vector(double* h, const Vec3& v) { h[0] = v.x, h[1] = v.y, h[2] = v.z; }

  void get_history(const double* h, int k) {
    if constexpr (Law::has_tangential_history)
      batch_.tangential_history.set(k, vector_at(h));
    if constexpr (Law::has_rolling_history)
      batch_.rolling_history.set(k, vector_at(h + Law::rolling_offset));
  }
  void put_history(double* h, int k) const {
    if constexpr (Law::has_tangential_history)
      set_vector(h, batch_.tangential_history.at(k));
    if constexpr (Law::has_rolling_history)
      set_vector(h + Law::rolling_offset, batch_.rolling_history.at(k));
  }

  const Particles p_;
  ThreadContacts& contacts_;
  const Constants* constants_;
  int types_;
  double dt_;
  [[no_unique_address]] Heat heat_;
  const Range own_;
  ContactBatch batch_{};
  BatchConstants<Law, one_material> batch_constants_;
};

} // namespace granflux::particle_subset
