// SPDX-FileCopyrightText: 2026 The GranFlux developers
// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

#include <optional>
#include <span>
#include <vector>

#include <omp.h>

#include <granflux/coupling/contact_heat/contact_radius.hpp>

#include "contact.hpp"

namespace granflux::particle_subset {

/// Heat that the particles of one thread receive in a step [W], where the sums over all particles
/// of what they exchange with each other are zero but for rounding.
struct alignas(64) HeatSums {
  double conduction = 0; ///< from other particles, through contacts and gas
  double friction = 0;   ///< made in contacts, the particles' share: by sliding and rolling
  double damping = 0;    ///< likewise by dashpots
  double walls = 0;      ///< conducted from walls
  double to_walls = 0;   ///< made in contacts and gone into walls, not into particles
  double radiation = 0;  ///< from other particles and the surroundings

  HeatSums& operator+=(const HeatSums& o) &;
};

/// What one particle receives of each kind [W]: in steps that ask for it.
struct ContactHeatRates {
  double conduction = 0; ///< from other particles through contacts
  double made = 0;       ///< its share of what friction and damping make, at walls too
};
struct HeatDetails {
  double friction = 0, damping = 0; ///< of what is made [W]
  double conductance = 0;           ///< of all its contacts, those with walls too [W/K]
};
struct WallHeatRates {
  double conduction = 0; ///< from walls to the particle [W]
  double to_wall = 0;    ///< heat made in contacts that goes into the wall [W]
};
struct NearHeatRates {
  double gas_gap = 0;     ///< from other particles through the gas in the gaps [W]
  double radiation = 0;   ///< from other particles and the surroundings [W]
  double conductance = 0; ///< of both together [W/K]
};
struct HeatShown {
  ContactHeatRates* contacts = nullptr;
  HeatDetails* details = nullptr;
  WallHeatRates* walls = nullptr;
  NearHeatRates* near = nullptr;
  [[nodiscard]] bool wanted() const { return details != nullptr; }
};

/// Heat made in contacts in time steps between two steps of temperature, exact in each: kept until
/// the particles receive it.
struct KeptHeat {
  bool now = false;                               ///< this time step is one of those
  double dt = 0;                                  ///< of the time step [s]
  double *friction = nullptr, *damping = nullptr; ///< of owned particles [J]: added to
};

/// What resists the motion of one particle at a wall.
struct WallResistance {
  int particle;
  Resistance damping, rubbing;
};

/// What resists motion in this step: from it follows what the half kick adds to the heat that is
/// made (half_kick_heat.hpp).
struct Resistances {
  Resistance* damping = nullptr; ///< on owned particles: added to; null where it makes no heat
  Resistance* rubbing = nullptr; ///< likewise
  std::vector<WallResistance>* walls = nullptr; ///< of each thread: appended to
};

/// Arrays of the host, borrowed.
struct HeatArrays {
  const double* temperature = nullptr; ///< of owned particles and ghosts [K]
  double* rate = nullptr;              ///< that owned particles receive [W]: added to
  HeatSums* sums = nullptr;            ///< of each thread: added to
  HeatShown shown;                     ///< of owned particles: added to; null where not asked for
  KeptHeat kept;
  /// What the power of this time step counts in the rate of a step of temperature: one over the
  /// number of time steps that it spans.
  double part_of_step = 1;
  Resistances resistances;

  /// Adds to particle p its share of what friction and dashpots make in this time step [W].
  /// `of_thread`: the sums of the one that calls.
  void add_made(int p, double friction, double damping, HeatSums& of_thread) const;
};

/// How the heat of friction is found: not at all, from the slider's own work, or as
/// mu |F_n| |slip| while a contact slides.
enum class FrictionHeat { off, slider, speed };

struct ContactHeatOptions {
  std::optional<coupling::AnyContactRadius> radius; ///< of conduction; empty: there is none
  FrictionHeat friction = FrictionHeat::slider;
  bool damping = false;    ///< heat of dashpots
  double wall_share = 0.5; ///< of the heat made at a wall that goes into the wall

  /// All that contacts dissipate is heat: what springs lose by steps of finite length is, too.
  [[nodiscard]] bool all_dissipated() const { return damping && friction == FrictionHeat::slider; }
  /// Contacts make nothing but the slider's own work, or not even that.
  [[nodiscard]] bool slider_at_most() const { return !damping && friction != FrictionHeat::speed; }
};

/// The material of one type, with its true modulus where the spring is softened.
struct ThermalMaterial {
  double conductivity; ///< W/(m K)
  double young;        ///< Pa; of no use where the radius of contact is found from the overlap
  double poisson;
};

/// Conduction through contacts and the heat made in them (docs/theory_heat.md).
class ContactHeat {
public:
  struct PairConstants {
    double conductance_per_radius; ///< W/(m K)
    double inverse_modulus;        ///< 1/Pa
    double overlap_ratio; ///< overlap that the true material would have over that of the spring
    double share;         ///< of the first one in the heat that is made
  };

  ContactHeat() = default;
  /// `overlap_ratio`: of each pair of types, row by row.
  ContactHeat(const ContactHeatOptions& options, std::span<const ThermalMaterial> materials,
              std::span<const double> overlap_ratio);

  [[nodiscard]] const ContactHeatOptions& options() const { return options_; }
  /// Of types from 1 on.
  [[nodiscard]] const PairConstants& pair(int a, int b) const {
    return pairs_[std::size_t((a - 1) * types_ + b - 1)];
  }
  [[nodiscard]] int types() const { return types_; }
  /// Whether conduction can do without the force of the contact.
  [[nodiscard]] bool needs_no_force() const;

  /// Of two touching spheres [W/K]; `force` is what presses them together.
  [[nodiscard]] double conductance(const PairConstants& pair, double radius_i, double radius_j,
                                   double overlap, double force) const;
  [[nodiscard]] double conductance_at_wall(const PairConstants& pair, double radius, double overlap,
                                           double force) const;
  /// What the options count of the heat of sliding and rolling [W].
  [[nodiscard]] double friction(const Dissipation& heat) const {
    return options_.all_dissipated()                   ? heat.sliding + heat.rolling + heat.turning
           : options_.friction == FrictionHeat::slider ? heat.sliding + heat.rolling
           : options_.friction == FrictionHeat::speed  ? heat.sliding_by_speed() + heat.rolling
                                                       : 0;
  }

private:
  ContactHeatOptions options_;
  int types_ = 0;
  std::vector<PairConstants> pairs_;
};

/// The heat of contacts between particles in one step: the law and where it finds and leaves it.
struct HeatOfContacts {
  const ContactHeat* law = nullptr;
  HeatArrays arrays;
  /// Nothing is conducted in this time step, and nothing made that counts.
  [[nodiscard]] bool rests() const {
    return arrays.kept.now && !arrays.kept.friction && !arrays.kept.damping;
  }
  /// Nothing is conducted in this time step, and nothing made that counts but the slider's work.
  [[nodiscard]] bool keeps_sliders_work_alone() const {
    return arrays.kept.now && arrays.kept.friction && law->options().slider_at_most();
  }
};

/// Heat at one wall; without a temperature nothing is conducted.
struct HeatOfWall {
  HeatOfContacts contacts;
  std::optional<double> temperature; ///< K

  /// Adds what particle p of a type exchanges with the wall of another.
  void add(int p, int type, int wall_type, double radius, double overlap, double force,
           const Dissipation& made) const;
  /// Notes what resists a particle's motion there.
  void resist(const WallResistance& resistance) const {
    contacts.arrays.resistances.walls[omp_get_thread_num()].push_back(resistance);
  }
  /// Adds the particle's and the wall's share of what friction and dashpots make [W].
  void add_made(int p, double friction, double damping) const { give(p, 0, 0, friction, damping); }
  /// Adds the particle's and the wall's share of what is left in the springs of a contact that has
  /// ended [W].
  void add_parted(int p, double power) const;

private:
  /// `friction`, `damping`: all that is made.
  void give(int p, double conduction, double conductance, double friction, double damping) const;
};

/// The sliders' work at one wall by one thread, in a time step in which it is all the heat that
/// counts (HeatOfContacts::keeps_sliders_work_alone()).
class KeptAtWall {
public:
  explicit KeptAtWall(const HeatOfWall& wall)
      : arrays_(wall.contacts.arrays), wall_share_(wall.contacts.law->options().wall_share) {}
  ~KeptAtWall() { arrays_.sums[omp_get_thread_num()].to_walls += wall_share_ * power_; }
  KeptAtWall(const KeptAtWall&) = delete;
  KeptAtWall& operator=(const KeptAtWall&) = delete;

  /// The particle's share is kept, the wall's is summed [W].
  void add(int p, double power) {
    arrays_.kept.friction[p] += arrays_.kept.dt * ((1 - wall_share_) * power);
    power_ += power;
  }

private:
  const HeatArrays& arrays_;
  const double wall_share_;
  double power_ = 0;
};

} // namespace granflux::particle_subset
