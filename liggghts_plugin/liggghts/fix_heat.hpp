// SPDX-FileCopyrightText: 2026 The GranFlux developers
// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include <liggghts/fix.h>

#include <granflux/coupling/particle_view.hpp>

#include "driver/heat_books.hpp"
#include "driver/heat_options.hpp"
#include "driver/heat_report.hpp"
#include "heat_materials.hpp"
#include "particle_subset/heat_port.hpp"
#include "particle_subset/temperature_step.hpp"

namespace LAMMPS_NS {
class FixPropertyAtom;
class PairGran;
} // namespace LAMMPS_NS

namespace granflux::particle_subset {
class PairGran;
} // namespace granflux::particle_subset

namespace granflux::liggghts {

/// fix ID all granflux/heat initial_temperature T ...: a temperature for every particle, conduction
/// through contacts and gaps, radiation, the heat of friction
/// (docs/reference/fix_granflux_heat.md).
class FixHeat : public LAMMPS_NS::Fix, public particle_subset::HeatPort {
public:
  FixHeat(LAMMPS_NS::LAMMPS* lammps, int narg, char** arg);

  int setmask() override;
  void post_create() override;
  void pre_delete(bool unfix) override;
  void init() override;
  void setup_pre_exchange() override;
  void setup(int) override;
  void pre_force(int) override;
  void pre_final_integrate() override;
  void post_run() override;
  /// Heat of all particles, sum of m c T [J].
  double compute_scalar() override;
  double compute_vector(int n) override;
  void write_restart(FILE* file) override;
  void restart(char* block) override;

  [[nodiscard]] particle_subset::HeatOfContacts heat_of_contacts() override;
  [[nodiscard]] double reach() const override { return reach_; }
  [[nodiscard]] double* parted_heat() override;

  /// In each run between init() and the first step: the gas brings about the steps of temperature
  /// itself, by step_with_gas().
  void leave_steps_to_gas() { steps_by_gas_ = true; }
  /// The step of this time step; returns the heat that this rank's particles took from the gas [J].
  /// `states`: of the owned particles.
  double step_with_gas(coupling::HeatState* states);
  /// Temperatures and heat capacities of the owned particles, and which stay as they are.
  void show_to_gas(coupling::ParticleView& view);
  /// Adds what particles conduct and radiate, and the temperatures of particles and walls.
  /// Collective.
  void describe(coupling::SceneState& scene);

private:
  LAMMPS_NS::FixPropertyAtom* property(const char* name, int values, bool restarts, bool ghosts,
                                       double initial);
  void check_script() const;
  void make_properties();
  void choose_effects();
  [[nodiscard]] coupling::SceneState scene();
  void warn_of_neglected();
  /// Contacts make or conduct heat.
  [[nodiscard]] bool touches() const {
    return options_.available().has(driver::Effect::conduction) ||
           options_.available().has(driver::Effect::friction) ||
           options_.available().has(driver::Effect::damping);
  }
  /// Temperatures stay as they are: chosen so, and no gas changes them.
  [[nodiscard]] bool rests() const {
    return options_.effects.given() && !options_.available().any() && !steps_by_gas_;
  }
  [[nodiscard]] bool wants_details() const;
  void link_walls();
  void conduct_by_shape();
  void step(coupling::HeatState* gas);
  void receive_parted_heat();
  void check_time_step(const particle_subset::HeatedParticles& particles) const;
  [[nodiscard]] particle_subset::HeatShown shown() const;
  [[nodiscard]] driver::WarmParticles particles() const;
  void look_at_temperatures();
  [[nodiscard]] double heat_of_all_ranks() const;
  [[nodiscard]] std::string effects() const;
  [[nodiscard]] int held_bits() const;

  driver::HeatOptions options_;
  driver::HeatOptions of_words_; // before effects were left out: what the numbers are made of
  driver::EffectSet available_;  // of the words
  bool chosen_ = false;          // effects are, and the table is printed
  driver::EffectWatch watch_;
  double near_seconds_ = 0, step_seconds_ = 0, particle_steps_ = 0; // of this rank and run
  HeatMaterials materials_;
  particle_subset::ContactHeat law_;

  // Kept by LIGGGHTS for each particle.
  LAMMPS_NS::FixPropertyAtom *temperature_ = nullptr, *carry_ = nullptr, *heat_flux_ = nullptr,
                             *source_ = nullptr, *contacts_ = nullptr, *details_ = nullptr,
                             *walls_ = nullptr, *near_ = nullptr, *parted_ = nullptr;
  std::vector<std::string> own_properties_;

  particle_subset::PairGran* subsets_ = nullptr; // in whose contact loops heat is made, or null:
  LAMMPS_NS::PairGran* pair_ = nullptr;          // beside those of LIGGGHTS
  particle_subset::NearHeat near_law_;
  double reach_ = 0;                            // of near_law_ [m]
  std::vector<particle_subset::HeatSums> sums_; // of each thread, of this step
  int held_ = 0;
  bool steps_by_gas_ = false;
  std::vector<double> heat_capacity_; // of each particle [J/K]
  std::vector<std::uint8_t> is_held_;
  bool said_ = false;                   // what is in use
  std::optional<double> heat_at_start_; // of all ranks when the books were opened [J]
  driver::HeatPowers powers_;           // of the last step, this rank
  driver::HeatBooks books_;             // of this rank
  driver::HeatReport report_;
  LAMMPS_NS::bigint looked_at_ = -1; // step of report_
};

} // namespace granflux::liggghts
