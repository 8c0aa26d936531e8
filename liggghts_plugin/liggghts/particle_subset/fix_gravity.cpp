// SPDX-FileCopyrightText: 2026 The GranFlux developers
// SPDX-License-Identifier: GPL-2.0-or-later

#include "fix_gravity.hpp"

#include <mpi.h>

#include <liggghts/atom.h>

#include "say_once.hpp"
#include "team.hpp"

namespace granflux::particle_subset {

namespace {

constexpr int constant = 0; // the first of FixGravity's two choices for varflag

struct Weight {
  const double* mass; // kg
  const int* mask;
  int group;
  double acceleration[3]; // m/s2

  /// Adds to force [N], in the arithmetic of LIGGGHTS.
  void add(double* force, Range range) const {
    for (int i = range.begin; i < range.end; ++i)
      if (mask[i] & group)
        for (int d = 0; d < 3; ++d)
          force[3 * i + d] += mass[i] * acceleration[d];
  }
};

} // namespace

void FixGravity::post_force(int vflag) {
  if (varflag != constant || fm || fix_relax || !atom->rmass) {
    say_once(*lmp, "fix gravity with variables, multispheres or relaxed contacts is LIGGGHTS' own");
    LAMMPS_NS::FixGravity::post_force(vflag);
    return;
  }
  eflag = 0;
  energy_due_ = true;
  if (atom->nlocal == 0)
    return;
  const Weight weight{.mass = atom->rmass,
                      .mask = atom->mask,
                      .group = groupbit,
                      .acceleration = {xacc, yacc, zacc}};
  for_each_subset(atom->nlocal, [&](Range range) { weight.add(atom->f[0], range); });
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
