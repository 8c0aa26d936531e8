// SPDX-FileCopyrightText: 2026 The GranFlux developers
// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

#include <liggghts/fix_gravity.h>

#include "own_work.hpp"

namespace granflux::particle_subset {

/// fix gravity with every thread adding the weight of its own particles. Its energy is summed when
/// it is asked for. Multispheres, contacts that are relaxed and particles of one mass a type are
/// LIGGGHTS' own.
class FixGravity : public LAMMPS_NS::FixGravity, public OwnWork {
public:
  using LAMMPS_NS::FixGravity::FixGravity;

  void post_force(int vflag) override;
  double compute_scalar() override;

  bool begin_own_work(int eflag, int vflag) override;
  void own_work(int thread, Range block) override;

private:
  bool energy_due_ = false;
};

} // namespace granflux::particle_subset
