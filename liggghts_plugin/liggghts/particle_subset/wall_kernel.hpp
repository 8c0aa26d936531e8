// SPDX-FileCopyrightText: 2026 The GranFlux developers
// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

#include <memory>
#include <span>
#include <string>

#include "contact_heat.hpp"
#include "contact_kernel.hpp"
#include "material.hpp"
#include "particles.hpp"

namespace granflux::particle_subset {

/// A particle within its radius of a wall.
struct WallTouch {
  int particle;
  double gap;      ///< between surface and wall, not positive, m
  Vec3 separation; ///< from the wall's nearest point to the centre, m
  Vec3 wall_velocity;
  double* history; ///< of this contact: advanced
  Vec3 force;      ///< out: on the particle, N
};

/// The forces of walls by one choice of laws.
class WallKernel {
public:
  virtual ~WallKernel() = default;
  /// Doubles that a contact remembers.
  [[nodiscard]] virtual int history_size() const = 0;
  /// Whether friction resists by speed, not by a slider.
  [[nodiscard]] virtual bool rubs() const = 0;
  /// The constants of `types` types with each other: before a run.
  virtual void read(const Material& material, int types) = 0;
  /// Adds forces and torques to the particles, in the order of `touches`.
  virtual void add(const Particles& particles, std::span<WallTouch> touches, int wall_type,
                   double dt) const = 0;
  /// What is left to become heat of a contact with the wall that has ended in the last step, its
  /// gap no longer negative: what its springs held, less the work of their last forces [J].
  [[nodiscard]] virtual double left_at_parting(const Particles& particles, const WallTouch& last,
                                               int wall_type, double dt) const = 0;
  /// The same as add(), and the heat exchanged with this wall.
  virtual void add_with_heat(const Particles& particles, std::span<WallTouch> touches,
                             int wall_type, double dt, const HeatOfWall& heat) const = 0;
};

/// Null where one of the names is of no law here.
[[nodiscard]] std::unique_ptr<WallKernel> make_wall_kernel(const LawNames& names);

} // namespace granflux::particle_subset
