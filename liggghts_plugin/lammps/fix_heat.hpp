// SPDX-FileCopyrightText: 2026 The GranFlux developers
// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "fmt_of_lammps.hpp"

#include <lammps/fix.h>

#include <granflux/coupling/particle_view.hpp>

#include "driver/heat_books.hpp"
#include "driver/heat_report.hpp"
#include "driver/particle_rows.hpp"
#include "heat_words.hpp"

namespace granflux::lammps {

using driver::ParticleRows;

/// fix ID all granflux/heat initial_temperature T ...: a temperature for every particle, conduction
/// through contacts and the heat of friction (docs/reference/granflux_lammps.md).
class FixHeat : public LAMMPS_NS::Fix {
public:
  FixHeat(LAMMPS_NS::LAMMPS* lammps, int narg, char** arg);
  ~FixHeat() override;
  FixHeat(const FixHeat&) = delete;
  FixHeat& operator=(const FixHeat&) = delete;

  int setmask() override;
  void init() override;
  void setup(int) override;
  void post_force(int) override;
  void post_run() override;
  /// Heat of all particles, sum of m c T [J].
  double compute_scalar() override;
  double compute_vector(int n) override;
  int modify_param(int narg, char** arg) override;
  void write_restart(FILE* file) override;
  void restart(char* block) override;

  // Temperatures of the particles.
  void grow_arrays(int n) override;
  void copy_arrays(int from, int to, int) override;
  void set_arrays(int particle) override;
  int pack_exchange(int particle, double* buffer) override;
  int unpack_exchange(int particle, double* buffer) override;
  int pack_restart(int particle, double* buffer) override;
  void unpack_restart(int particle, int nth) override;
  int size_restart(int) override;
  int maxsize_restart() override;
  double memory_usage() override;
  int pack_forward_comm(int n, int* list, double* buffer, int, int*) override;
  void unpack_forward_comm(int n, int first, double* buffer) override;
  int pack_reverse_comm(int n, int first, double* buffer) override;
  void unpack_reverse_comm(int n, int* list, double* buffer) override;

  /// In each run between init() and the first step: the gas brings about the steps of temperature
  /// itself, by step_with_gas().
  void leave_steps_to_gas() { steps_by_gas_ = true; }
  /// The step of this time step; returns the heat that this rank's particles took from the gas [J].
  /// `states`: of the owned particles.
  double step_with_gas(coupling::HeatState* states);
  /// Temperatures and heat capacities of the owned particles, and which stay as they are.
  void show_to_gas(coupling::ParticleView& view);
  /// Adds what particles conduct, and their temperatures. Collective.
  void describe(coupling::SceneState& scene);

private:
  /// What the contacts of a particle bring it in this step.
  struct Contacts {
    double rate = 0;        ///< received [W]
    double conductance = 0; ///< of all of them [W/K]
  };

  void check_script() const;
  void choose_effects();
  void find_law();
  [[nodiscard]] coupling::SceneState scene();
  void warn_of_neglected();
  /// Temperatures stay as they are: chosen so, and no gas changes them.
  [[nodiscard]] bool rests() const {
    return words_.options.effects.given() && !touching_ && !steps_by_gas_;
  }
  void check_pair_style() const;
  [[nodiscard]] int held_bits() const;
  void sum_contacts();
  [[nodiscard]] double friction_heat(const double* told, int i, int j, const Vec3& apart,
                                     double squared) const;
  void step(coupling::HeatState* gas);
  void check_time_step() const;
  [[nodiscard]] driver::WarmParticles particles() const;
  [[nodiscard]] double heat_of_all_ranks() const;
  void look_at_temperatures();
  void set_temperatures(const char* of_group, const char* kelvin);

  HeatWords words_;
  driver::EffectSet available_; // of the words
  bool chosen_ = false;         // effects are, and the table is printed
  driver::EffectWatch watch_;
  particle_subset::ContactHeat law_;
  bool touching_ = false;     ///< contacts exchange or make heat
  int held_ = 0, frozen_ = 0; ///< groups: of fixed temperature, held in place
  bool steps_by_gas_ = false;

  ParticleRows temperature_; // K
  ParticleRows carry_;       // what rounding has kept from it [K]
  std::vector<Contacts> contacts_;
  std::vector<double> rate_, no_source_, heat_capacity_;
  std::vector<std::uint8_t> is_held_;

  std::optional<double> heat_at_start_; // of all ranks when the books were opened [J]
  driver::HeatPowers powers_;           // of the last step, this rank
  driver::HeatBooks books_;             // of this rank
  driver::HeatReport report_;
  LAMMPS_NS::bigint looked_at_ = -1; // step of report_
};

} // namespace granflux::lammps
