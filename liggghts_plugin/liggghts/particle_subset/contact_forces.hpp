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
        heat_(heat), own_(contacts.own), one_size_(p_.alike.radius > 0 && !p_.frozen_group),
        batch_constants_(of_pair(first_type(), first_type())) {
    if constexpr (Heat::acts) // of the one type, or of any: lanes without a pair must have some
      for (int k = 0; k < ContactBatch::capacity; ++k)
        heat_.set_constants(k, first_type(), first_type());
    if (one_size_)
      for (int k = 0; k < ContactBatch::capacity; ++k) {
        batch_.radius_i[k] = batch_.radius_j[k] = p_.alike.radius;
        batch_.mass_i[k] = batch_.mass_j[k] = p_.alike.mass;
      }
  }

  /// Along the lower rows, all of them.
  void add_lower() { add_rows<Side::lower>(contacts_.lower, own_); }
  /// Along the upper rows of some of the particles.
  void add_upper(Range particles) { add_rows<Side::upper>(contacts_.upper, particles); }

private:
  /// Which of a pair is the particle of the row: j of the lower rows, i of the upper.
  enum class Side { lower, upper };
  template <Side side> static const int* particles_i(const ContactRows& rows) {
    return (side == Side::upper ? rows.particle : rows.partner).data();
  }
  template <Side side> static const int* particles_j(const ContactRows& rows) {
    return (side == Side::upper ? rows.partner : rows.particle).data();
  }

  /// The type of all particles, where one is known.
  [[nodiscard]] int first_type() const { return std::max(p_.alike.type, 1); }
  [[nodiscard]] const Constants& of_pair(int type_i, int type_j) const {
    return constants_[(type_i - 1) * types_ + type_j - 1];
  }

  template <Side side> void add_rows(ContactRows& rows, Range particles) {
    if (one_size_)
      add_rows<side, true>(rows, particles);
    else
      add_rows<side, false>(rows, particles);
  }
  template <Side side, bool one_size> void add_rows(ContactRows& rows, Range particles) {
    int count = 0;
    rows.for_each_run(
        particles.begin - own_.begin, particles.end - own_.begin, [&](int first, int end) {
          for (int e = first; e < end; e += stretch) {
            count = measure<side, one_size>(rows, e, std::min(e + stretch, end), count);
            if (count >= ContactBatch::full) {
              finish<side>(rows, ContactBatch::full);
              count = keep_rest(count);
            }
          }
        });
    finish<side>(rows, count);
  }

  /// Pairs that are measured in one go.
  static constexpr int stretch = 16;
  static_assert(ContactBatch::full + stretch <= ContactBatch::capacity);

  /// What is behind a full batch begins the next: loops over batches of one length end where the
  /// machine foresees it, and no lanes are idle.
  int keep_rest(int count) {
    const int rest = count - ContactBatch::full;
    for (int k = 0; k < rest; ++k) {
      batch_.entry[k] = batch_.entry[ContactBatch::full + k];
      batch_.measured[k] = batch_.measured[ContactBatch::full + k];
    }
    return rest;
  }

  /// Puts those of the pairs first ... end - 1 that touch into the batch behind the `count` that it
  /// holds, and returns how many it holds then. Pair after pair, not row after row: the machine
  /// cannot foresee where rows end.
  template <Side side, bool one_size>
  int measure(const ContactRows& rows, int first, int end, int count) {
    const int last = int(rows.partner.size()) - 1;
    const int* const partner = rows.partner.data();
    const int *const of_i = particles_i<side>(rows), *const of_j = particles_j<side>(rows);
    const double* const history = rows.history.data();
    const Particles p = p_; // in registers: what is written might else change it
    const double diameter = 2 * p.alike.radius;
    for (int e = first; e < end; ++e) {
      prefetch_place<one_size>(p, partner[std::min(e + ahead, last)]);
      const int i = of_i[e], j = of_j[e];
      prefetch<one_size>(p, partner[e]);
      if constexpr (Law::history > 0)
        __builtin_prefetch(history + std::ptrdiff_t(e) * Law::history, 1);
      Four measured, place_j;
      take(measured, p.position[i]);
      take(place_j, p.position[j]);
      measured -= place_j;
      const Four squares = measured * measured;
      const double squared = squares[0] + squares[1] + squares[2];
      const double radii = one_size ? diameter : p.radius[i] + p.radius[j];
      measured[3] = squared;
      batch_.entry[count] = e;
      batch_.measured[count] = measured;
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

  template <bool one_size> static void prefetch_place(const Particles& p, int partner) {
    __builtin_prefetch(p.position + partner);
    if constexpr (!one_size)
      __builtin_prefetch(p.radius + partner);
  }

  /// What gather and scatter will want of a pair comes from far while other pairs are measured. Not
  /// what heat wants: its arrays are so dense that the machine fetches them ahead by itself, and
  /// fetching them here took a tenth of the loop.
  template <bool one_size> static void prefetch(const Particles& p, int partner) {
    __builtin_prefetch(p.velocity + partner);
    if constexpr (!one_size)
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
    gather<side>(rows, count);
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

  template <Side side> void gather(const ContactRows& rows, int count) {
    const int whole = ContactBatch::whole_groups(count);
    for (int k = count; k < whole; ++k) { // lanes that no pair is left for repeat the last one
      batch_.entry[k] = batch_.entry[count - 1];
      batch_.measured[k] = batch_.measured[count - 1];
    }
    const int *const of_i = particles_i<side>(rows), *const of_j = particles_j<side>(rows);
    for (int k = 0; k < whole; ++k) {
      batch_.i[k] = of_i[batch_.entry[k]];
      batch_.j[k] = of_j[batch_.entry[k]];
    }
    gather_motion(whole);
    if (!one_size_)
      gather_sizes(whole);
    if constexpr (Law::has_tangential_history)
      gather_history(&rows.history[0], whole, batch_.tangential_history);
    if constexpr (Law::has_rolling_history)
      gather_history(&rows.history[Law::rolling_offset], whole, batch_.rolling_history);
    if constexpr (!one_material || Heat::acts)
      for (int k = 0; k < whole; ++k) {
        const int i = batch_.i[k], j = batch_.j[k];
        if constexpr (!one_material) {
          batch_constants_.set(k, of_pair(p_.type[i], p_.type[j]));
          if constexpr (Heat::acts)
            heat_.set_constants(k, p_.type[i], p_.type[j]);
        }
        if constexpr (Heat::acts)
          heat_.gather(k, i, j);
      }
  }

  // Array after array, so that what leads to the particles of four pairs stays in registers.

  void gather_motion(int whole) {
    const int *const i = batch_.i, *const j = batch_.j;
    const Vec3* const velocity = p_.velocity;
    FourRows rows;
    for (int k = 0; k < whole; k += 4) {
      for (int n = 0; n < 4; ++n)
        rows[n] = batch_.measured[k + n];
      batch_.separation.set_four(k, rows);
      ContactBatch::put(rows[3], batch_.distance_squared + k);
    }
    for (int k = 0; k < whole; k += 4) {
      for (int n = 0; n < 4; ++n) {
        Four of_j;
        take(rows[n], velocity[i[k + n]]);
        take(of_j, velocity[j[k + n]]);
        rows[n] -= of_j;
      }
      batch_.velocity.set_four(k, rows);
    }
    if constexpr (Law::turns) {
      gather_spin(i, whole, batch_.spin_i);
      gather_spin(j, whole, batch_.spin_j);
    }
  }

  void gather_spin(const int* particle, int whole, ContactBatch::Vectors& spins) const {
    const Vec3* const spin = p_.spin;
    FourRows rows;
    for (int k = 0; k < whole; k += 4) {
      for (int n = 0; n < 4; ++n)
        take(rows[n], spin[particle[k + n]]);
      spins.set_four(k, rows);
    }
  }

  void gather_sizes(int whole) {
    gather_numbers(p_.radius, batch_.i, whole, batch_.radius_i);
    gather_numbers(p_.radius, batch_.j, whole, batch_.radius_j);
    gather_numbers(p_.mass, batch_.i, whole, batch_.mass_i);
    gather_numbers(p_.mass, batch_.j, whole, batch_.mass_j);
    if (p_.frozen_group)
      freeze(whole);
  }

  static void gather_numbers(const double* of, const int* particle, int whole, double* column) {
    for (int k = 0; k < whole; k += 4)
      ContactBatch::put(
          Four{of[particle[k]], of[particle[k + 1]], of[particle[k + 2]], of[particle[k + 3]]},
          column + k);
  }

  void gather_history(const double* of, int whole, ContactBatch::Vectors& history) const {
    FourRows rows;
    for (int k = 0; k < whole; k += 4) {
      for (int n = 0; n < 4; ++n)
        take(rows[n], of + std::ptrdiff_t(batch_.entry[k + n]) * Law::history);
      history.set_four(k, rows);
    }
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

  static void set_vector(double* h, const Vec3& v) { h[0] = v.x, h[1] = v.y, h[2] = v.z; }

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
  const bool one_size_; // and mass, for all: not gathered
  ContactBatch batch_{};
  BatchConstants<Law, one_material> batch_constants_;
};

} // namespace granflux::particle_subset
