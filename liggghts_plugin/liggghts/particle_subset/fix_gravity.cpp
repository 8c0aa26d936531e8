// SPDX-FileCopyrightText: 2026 The GranFlux developers
// SPDX-License-Identifier: GPL-2.0-or-later

#include "fix_gravity.hpp"

#include <mpi.h>

#include <liggghts/atom.h>

#include "kick.hpp"
#include "say_once.hpp"
#include "team.hpp"

namespace granflux::particle_subset {

namespace {

constexpr int constant = 0; // the first of FixGravity's two choices for varflag

} // namespace

bool FixGravity::begin_own_work(int /*eflag*/, int /*vflag*/) {
  if (varflag != constant || fm || fix_relax || !atom->rmass) {
    say_once(*lmp, "fix gravity with variables, multispheres or relaxed contacts is LIGGGHTS' own");
    return false;
  }
  // The energy is summed if it is asked for.
  LAMMPS_NS::FixGravity::eflag = 0;
  energy_due_ = true;
  return true;
}

void FixGravity::own_work(int /*thread*/, Range block) {
  if (block.size() == 0)
    return;
  const double acceleration[3] = {xacc, yacc, zacc};
  add_weight(acceleration, groupbit, atom->rmass, atom->mask, atom->f[0], block);
}

void FixGravity::post_force(int vflag) {
  if (!begin_own_work(0, vflag)) {
    LAMMPS_NS::FixGravity::post_force(vflag);
    return;
  }
  for_each_subset(atom->nlocal, [&](Range range) { own_work(0, range); });
}

double FixGravity::compute_scalar() {
  if (energy_due_) {
    energy_due_ = false;
    egrav = 0;
    for (int i = 0; i < atom->nlocal; ++i)
      if (atom->mask[i] & groupbit) {
        const double* x = atom->x[i];
        egrav -= atom->rmass[i] * (xacc * x[0] + yacc * x[1] + zacc * x[2]);
      }
  }
  return LAMMPS_NS::FixGravity::compute_scalar();
}

} // namespace granflux::particle_subset
