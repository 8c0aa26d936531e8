// SPDX-FileCopyrightText: 2026 The GranFlux developers
// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "fmt_of_lammps.hpp"

#include <lammps/fix.h>

#include <granflux/coupling/particle_view.hpp>

#include "driver/heat_fix.hpp"
#include "driver/particle_rows.hpp"
#include "heat_words.hpp"

namespace granflux::lammps {

using driver::ParticleRows;

class FixCouple;

/// fix ID all granflux/heat initial_temperature T ...: a temperature for every particle, conduction
/// through contacts and the heat of friction (docs/reference/granflux_lammps.md).
class FixHeat : public driver::HeatFix<LAMMPS_NS::Fix, FixCouple> {
public:
  FixHeat(LAMMPS_NS::LAMMPS* lammps, int narg, char** arg);
  ~FixHeat() override;
  FixHeat(const FixHeat&) = delete;
  FixHeat& operator=(const FixHeat&) = delete;

  int setmask() override;
  void init() override;
  void setup(int) override;
  void post_force(int) override;
  int modify_param(int narg, char** arg) override;

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

  void describe(coupling::SceneState& scene) override;

private:
  /// What the contacts of a particle bring it in this step.
  struct Contacts {
    double rate = 0;        ///< received [W]
    double conductance = 0; ///< of all of them [W/K]
  };

  void check_script() const;
  void find_law();
  void check_pair_style() const;
  driver::HeatPowers sum_contacts();
  [[nodiscard]] double friction_heat(const double* told, int i, int j, const Vec3& apart,
                                     double squared) const;
  void step(coupling::HeatState* gas) override;
  void check_time_step() const;
  [[nodiscard]] const driver::HeatOptions& options() const override { return words_.options; }
  [[nodiscard]] driver::WarmParticles particles() const override;
  [[nodiscard]] std::optional<driver::HeatReport::Conduction> conduction() const override;
  [[nodiscard]] std::optional<Vec3> gravity() const override;
  [[nodiscard]] std::string method() const override;
  void keep(driver::EffectSet on) override;
  void set_temperatures(const char* of_group, const char* kelvin);

  HeatWords words_;
  particle_subset::ContactHeat law_;
  bool touching_ = false; ///< contacts exchange or make heat
  int frozen_ = 0;        ///< groups held in place

  ParticleRows temperature_; // K
  ParticleRows carry_;       // what rounding has kept from it [K]
  std::vector<Contacts> contacts_;
  std::vector<double> rate_, no_source_;
};

} // namespace granflux::lammps
