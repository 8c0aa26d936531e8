// SPDX-FileCopyrightText: 2026 The GranFlux developers
// SPDX-License-Identifier: GPL-2.0-or-later

#include "fix_nve_sphere.hpp"

#include <algorithm>
#include <cmath>

#include <liggghts/atom.h>

#include <liggghts/domain.h>

#include "neighbor.hpp"
#include "team.hpp"

namespace granflux::particle_subset {

namespace {

constexpr int no_dipole = 0; // the first of FixNVESphere's two choices for `extra`
constexpr double sphere_inertia = 0.4, disc_inertia = 0.5;

} // namespace

bool FixNveSphere::may_owe() const {
  return extra == no_dipole;
}

HalfKick FixNveSphere::half_kick() const {
  const double inertia = domain->dimension == 2 ? disc_inertia : sphere_inertia;
  return {.half_step = dtf,
          .half_step_inertia = dtf / inertia,
          .mass_factor = onePlusCAddRhoFluid_,
          .group = groupbit};
}

Spheres FixNveSphere::spheres() const {
  return {.position = atom->x[0],
          .velocity = atom->v[0],
          .angular_velocity = atom->omega[0],
          .force = atom->f[0],
          .torque = atom->torque[0],
          .radius = atom->radius,
          .mass = atom->rmass,
          .mask = atom->mask};
}

int FixNveSphere::count() const {
  return igroup == atom->firstgroup ? atom->nfirst : atom->nlocal;
}

void FixNveSphere::initial_integrate(int vflag) {
  if (extra != no_dipole) {
    FixNVESphere::initial_integrate(vflag);
    return;
  }
  const int halves = owed_ ? 2 : 1;
  owed_ = false;
  if (count() == 0)
    return;
  const HalfKick half = half_kick();
  const Spheres all = spheres();
  double fastest = 0;
  for_each_subset(count(), [&](Range range) {
    const double squared = kick_and_move(half, halves, dtv, all, range);
#pragma omp critical(granflux_fastest_particle)
    fastest = std::max(fastest, squared);
  });
  if (auto* own = dynamic_cast<Neighbor*>(neighbor))
    own->moved_at_most(dtv * std::sqrt(fastest));
}

void FixNveSphere::final_integrate() {
  if (extra != no_dipole) {
    FixNVESphere::final_integrate();
    return;
  }
  owed_ = false;
  if (count() == 0)
    return;
  const HalfKick half = half_kick();
  const Spheres all = spheres();
  for_each_subset(count(), [&](Range range) { kick(half, all, range); });
}

} // namespace granflux::particle_subset
