// SPDX-FileCopyrightText: 2026 The GranFlux developers
// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

#include <memory>

#include <liggghts/fix.h>

#include "driver/checkpointer.hpp"
#include "driver/kept_forces.hpp"
#include "particle_subset/rare_look.hpp"

namespace granflux::liggghts {

/// fix ID all granflux/checkpoint FILE every N: restart files from which a run goes on to the last
/// bit (docs/reference/fix_granflux_checkpoint.md).
class FixCheckpoint : public LAMMPS_NS::Fix, public particle_subset::RareLook {
public:
  FixCheckpoint(LAMMPS_NS::LAMMPS* lammps, int narg, char** arg);
  ~FixCheckpoint() override;

  /// The forces of the last step are known, so that the run that is set up needs no others.
  [[nodiscard]] bool brings_forces() const { return kept_.are_of(this_step()); }
  [[nodiscard]] const driver::Checkpointer& point() const { return *point_; }

  int setmask() override;
  void init() override;
  void setup(int) override;
  void pre_exchange() override;
  void end_of_step() override;
  [[nodiscard]] bool looks_at(long step) const override { return step == point_->due(); }

  void write_restart(FILE* file) override;
  void restart(char* block) override;

  void grow_arrays(int n) override;
  void copy_arrays(int from, int to, int) override;
  void set_arrays(int particle) override;
  int pack_exchange(int particle, double* buffer) override;
  int unpack_exchange(int particle, double* buffer) override;
  int pack_restart(int particle, double* buffer) override;
  void unpack_restart(int particle, int nth) override;
  int size_restart(int particle) override;
  int maxsize_restart() override;

private:
  template <class Work> void guard(Work&& work);
  [[nodiscard]] driver::KeptForces::Step this_step() const;
  void say(const std::string& text) const;

  std::unique_ptr<driver::Checkpointer> point_;
  driver::KeptForces kept_;
  bool writing_ = false; ///< what is packed goes to a checkpoint
};

} // namespace granflux::liggghts
