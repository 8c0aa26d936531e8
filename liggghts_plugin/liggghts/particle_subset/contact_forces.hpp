// SPDX-FileCopyrightText: 2026 The GranFlux developers
// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

#include <algorithm>

#include "contact_batch.hpp"
#include "contact_lists.hpp"
#include "heat_batch.hpp"

namespace granflux::particle_subset {

/// The contact forces of one thread: goes along its rows, takes the pairs that touch and hands them
/// to the law in batches. Writes only what belongs to the particles of the range. Heat: a
/// HeatBatch, or WithoutHeat where there is none.
template <class Law, bool one_material, class Heat> class ContactForces {
public:
  using Constants = typename Law::Constants;

  /// `constants`: of each pair of the `types` types.
  ContactForces(const Particles& particles, ThreadContacts& contacts, const Constants* constants,
                int types, double dt, const typename Heat::Source& heat)
      : p_(particles), contacts_(contacts), constants_(constants), types_(types), dt_(dt),
        heat_(heat), own_(contacts.own), batch_constants_(constants[0]) {}

  /// Along the lower rows, all of them.
  void add_lower() {
    add_rows(contacts_.lower, own_, [](int own, int partner) { return std::pair(partner, own); });
  }
  /// Along the upper rows of some of the particles.
  void add_upper(Range particles) {
    add_rows(contacts_.upper, particles,
             [](int own, int partner) { return std::pair(own, partner); });
  }

private:
  template <class Ordered> void add_rows(ContactRows& rows, Range particles, Ordered ordered) {
    int count = 0;
    const int last = int(rows.partner.size()) - 1;
    const int end_row = particles.end - own_.begin;
    const int* const ends = rows.work_ends();
    for (int row = particles.begin - own_.begin; row < end_row; ++row) {
      const int end = ends[row];
      for (int e = rows.row_begin(row); e < end; ++e) {
        prefetch_place(rows.partner[std::size_t(std::min(e + ahead, last))]);
        const int partner = rows.partner[std::size_t(e)];
        const auto [i, j] = ordered(own_.begin + row, partner);
        const Vec3 separation = p_.position[i] - p_.position[j];
        const double squared = dot(separation, separation);
        const double radii = p_.radius[i] + p_.radius[j];
        batch_.i[count] = i;
        batch_.j[count] = j;
        batch_.entry[count] = e;
        batch_.separation.set(count, separation);
        batch_.distance_squared[count] = squared;
        prefetch(rows, e, partner);
        // Overwritten by the next pair unless this one touches.
        count += squared < radii * radii;
        if (count == ContactBatch::capacity) {
          finish(rows, count);
          count = 0;
        }
      }
    }
    finish(rows, count);
  }

  /// Entries from the fetching of a partner's place to its use: the time of a line from memory.
  static constexpr int ahead = 16;

  void prefetch_place(int partner) const {
    __builtin_prefetch(p_.position + partner);
    __builtin_prefetch(p_.radius + partner);
  }

  /// What gather and scatter will want of a pair comes from far while other pairs are measured. Not
  /// what heat wants: its arrays are so dense that the machine fetches them ahead by itself, and
  /// fetching them here took a tenth of the loop.
  void prefetch(const ContactRows& rows, int e, int p) const {
    __builtin_prefetch(p_.velocity + p);
    __builtin_prefetch(p_.mass + p);
    __builtin_prefetch(p_.force + p, 1);
    if constexpr (Law::history > 0)
      __builtin_prefetch(&rows.history[std::size_t(e) * Law::history], 1);
    if constexpr (Law::turns) {
      __builtin_prefetch(p_.spin + p);
      __builtin_prefetch(p_.torque + p, 1);
    }
  }

  void finish(ContactRows& rows, int count) {
    if (count == 0)
      return;
    gather(rows, count);
    evaluate(batch_, count, batch_constants_, dt_, heat_);
    if constexpr (Heat::acts)
      heat_.evaluate(batch_, count, own_);
    scatter(rows, count);
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
      if constexpr (!one_material)
        batch_constants_.set(k, constants_[(p_.type[i] - 1) * types_ + p_.type[j] - 1]);
      if constexpr (Law::history > 0)
        get_history(&rows.history[std::size_t(batch_.entry[k]) * Law::history], k);
      if constexpr (Heat::acts)
        heat_.gather(k, i, j, p_.type);
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

  void scatter(ContactRows& rows, int count) {
    for (int k = 0; k < count;) {
      const int i = batch_.i[k];
      if (!own_.holds(i)) {
        add_to_partner(k);
        put_memory(rows, k);
        ++k;
        continue;
      }
      // Along a row the force on its particle stays in registers.
      Vec3 force = p_.force[i], torque = p_.torque[i];
      [[maybe_unused]] double rate = 0;
      if constexpr (Heat::acts)
        rate = heat_.rate(i);
      for (; k < count && batch_.i[k] == i; ++k) {
        force += batch_.force.at(k);
        if constexpr (Law::turns)
          torque += batch_.torque_i.at(k);
        if constexpr (Heat::acts)
          rate += heat_.rate_of_i(k);
        if (own_.holds(batch_.j[k]))
          add_to_partner(k);
        put_memory(rows, k);
      }
      p_.force[i] = force;
      if constexpr (Law::turns)
        p_.torque[i] = torque;
      if constexpr (Heat::acts)
        heat_.rate(i) = rate;
    }
  }

  void add_to_partner(int k) {
    const int j = batch_.j[k];
    p_.force[j] -= batch_.force.at(k);
    if constexpr (Law::turns)
      p_.torque[j] += batch_.torque_j.at(k);
    if constexpr (Heat::acts)
      heat_.add_to_j(j, k);
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
