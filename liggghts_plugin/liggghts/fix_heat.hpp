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

#include "driver/heat_fix.hpp"
#include "heat_materials.hpp"
#include "particle_subset/heat_port.hpp"
#include "particle_subset/rare_look.hpp"
#include "particle_subset/temperature_step.hpp"
#include "particle_subset/work_ahead.hpp"

namespace LAMMPS_NS {
class FixPropertyAtom;
class PairGran;
} // namespace LAMMPS_NS

namespace granflux::particle_subset {
class PairGran;
} // namespace granflux::particle_subset

namespace granflux::liggghts {

class FixCouple;

/// fix ID all granflux/heat initial_temperature T ...: a temperature for every particle, conduction
/// through contacts and gaps, radiation, the heat of friction
/// (docs/reference/fix_granflux_heat.md).
class FixHeat : public driver::HeatFix<LAMMPS_NS::Fix, FixCouple>,
                public particle_subset::HeatPort,
                public particle_subset::RareLook,
                public particle_subset::WorkAhead {
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

  [[nodiscard]] particle_subset::HeatOfContacts heat_of_contacts() override;
  [[nodiscard]] double reach() const override { return reach_; }
  [[nodiscard]] double* parted_heat() override;

  /// Gaps and radiation are found from where particles are; all else from contacts and forces.
  [[nodiscard]] bool looks_at(long step) const override {
    return (options_.near.any() && step % options_.every == 0) || looks_at_scene(step);
  }
  [[nodiscard]] bool looks_at_forces() const override;
  /// Temperatures take their step, unless there is more to do or to look at between contacts and
  /// them.
  [[nodiscard]] particle_subset::OwnWork* work_ahead() override;

  void describe(coupling::SceneState& scene) override;

private:
  LAMMPS_NS::FixPropertyAtom* property(const char* name, int values, bool restarts, bool ghosts,
                                       double initial);
  void check_script() const;
  void make_properties();
  /// Contacts make or conduct heat.
  [[nodiscard]] bool touches() const {
    return options_.available().has(driver::Effect::conduction) ||
           options_.available().has(driver::Effect::friction) ||
           options_.available().has(driver::Effect::damping);
  }
  [[nodiscard]] bool wants_details() const;
  void link_walls();
  void conduct_by_shape();
  void step(coupling::HeatState* gas) override;
  [[nodiscard]] particle_subset::HeatedParticles heated_particles(coupling::HeatState* gas) const;
  particle_subset::StepPowers step_particles(const particle_subset::HeatedParticles& particles,
                                             particle_subset::Range range,
                                             particle_subset::HeatSums& sums);
  void book_heat_of_walls();
  [[nodiscard]] bool has_kept_heat() const;
  void receive_kept_heat(const particle_subset::HeatShown& shown, particle_subset::Range range,
                         particle_subset::HeatSums& sums);
  [[nodiscard]] particle_subset::Resistances resistances();
  void receive_half_kick_heat();
  void check_time_step(const particle_subset::HeatedParticles& particles) const;
  [[nodiscard]] particle_subset::HeatShown shown() const;
  [[nodiscard]] const driver::HeatOptions& options() const override { return options_; }
  [[nodiscard]] driver::WarmParticles particles() const override;
  [[nodiscard]] std::optional<driver::HeatReport::Conduction> conduction() const override;
  [[nodiscard]] std::optional<Vec3> gravity() const override;
  [[nodiscard]] std::string method() const override;
  void keep(driver::EffectSet on) override;

  driver::HeatOptions options_;
  driver::HeatOptions of_words_; // before effects were left out: what the numbers are made of
  double near_seconds_ = 0, step_seconds_ = 0, particle_steps_ = 0; // of this rank and run
  HeatMaterials materials_;
  particle_subset::ContactHeat law_;

  // Kept by LIGGGHTS for each particle.
  LAMMPS_NS::FixPropertyAtom *temperature_ = nullptr, *carry_ = nullptr, *heat_flux_ = nullptr,
                             *source_ = nullptr, *contacts_ = nullptr, *details_ = nullptr,
                             *walls_ = nullptr, *near_ = nullptr, *parted_ = nullptr,
                             *kept_damping_ = nullptr;
  std::vector<std::string> own_properties_;

  particle_subset::PairGran* subsets_ = nullptr; // in whose contact loops heat is made, or null:
  LAMMPS_NS::PairGran* pair_ = nullptr;          // beside those of LIGGGHTS
  particle_subset::NearHeat near_law_;
  double reach_ = 0;                            // of near_law_ [m]
  std::vector<particle_subset::HeatSums> sums_; // of each thread, of this step
  // Of each particle and of each thread, of this step.
  std::vector<particle_subset::Resistance> damping_, rubbing_;
  std::vector<std::vector<particle_subset::WallResistance>> at_walls_;

  /// The step of temperature of particles that no other thread sees, as soon as their heat is
  /// complete.
  struct StepAhead final : particle_subset::OwnWork {
    explicit StepAhead(FixHeat& all) : heat(all) {}
    FixHeat& heat;
    struct alignas(64) OfThread {
      particle_subset::Range done;
      particle_subset::StepPowers powers;
      double seconds = 0;
    };
    std::vector<OfThread> threads; ///< ascending; empty: nothing was done ahead
    bool begin_own_work(int eflag, int vflag) override;
    void own_work(int thread, particle_subset::Range block) override;
  } step_ahead_{*this};
};

} // namespace granflux::liggghts
