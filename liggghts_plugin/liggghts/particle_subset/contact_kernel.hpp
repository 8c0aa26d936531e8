// SPDX-FileCopyrightText: 2026 The GranFlux developers
// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

#include <memory>
#include <string>

#include "contact_heat.hpp"
#include "contact_lists.hpp"
#include "material.hpp"

namespace granflux::particle_subset {

/// The laws of a contact by the names that `pair_style gran` knows.
struct LawNames {
  std::string normal = "off", tangential = "off", rolling = "off", cohesion = "off";
};

/// The contact forces of one choice of laws, whose inner loop is compiled for that choice.
class ContactKernel {
public:
  virtual ~ContactKernel() = default;
  /// Doubles that a contact remembers.
  [[nodiscard]] virtual int history_size() const = 0;
  /// Whether friction resists by speed, not by a slider.
  [[nodiscard]] virtual bool rubs() const = 0;
  /// The constants of each pair of `types` types: before a run.
  virtual void read(const Material& material, int types) = 0;
  /// Adds the forces and torques on the particles of one thread, and brings its histories to the
  /// end of the step of `dt` seconds. Called by each thread for its own contacts: those with lower
  /// particles of other threads first, then its own rows, in one go or block after block. `heat`:
  /// what the contacts make and conduct of it is added too, by a loop of its own, so that the one
  /// without has nothing of it; null: none.
  virtual void add_lower(const Particles& particles, ThreadContacts& contacts, double dt,
                         const HeatOfContacts* heat = nullptr) const = 0;
  virtual void add_upper(const Particles& particles, ThreadContacts& contacts, Range block,
                         double dt, const HeatOfContacts* heat = nullptr) const = 0;
  /// Adds to `heat` [J], of owned particles, what the springs of contacts hold that have ended
  /// since the lists were built: it is lost to motion with the lists. For the particles of one
  /// thread.
  virtual void add_parted(const Particles& particles, const ThreadContacts& contacts, double dt,
                          const ContactHeat& law, double* heat) const = 0;
  void add(const Particles& particles, ThreadContacts& contacts, double dt,
           const HeatOfContacts* heat = nullptr) const {
    add_lower(particles, contacts, dt, heat);
    add_upper(particles, contacts, contacts.own, dt, heat);
  }
};

/// Null where one of the names is of no law here; says in `unknown` which.
[[nodiscard]] std::unique_ptr<ContactKernel> make_contact_kernel(const LawNames& names,
                                                                 std::string& unknown);

} // namespace granflux::particle_subset
