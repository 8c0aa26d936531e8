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
  double fastest = 0;
  for (const Ahead& ahead : ahead_)
    fastest = std::max(fastest, ahead.fastest);
  for_each_subset(count(), [&](Range own) {
    double squared = 0;
    int begin = own.begin;
    for (const Ahead& ahead : ahead_) {
      squared = std::max(squared, move(halves, {begin, std::min(ahead.moved.begin, own.end)}));
      begin = std::max(begin, ahead.moved.end);
    }
    squared = std::max(squared, move(halves, {begin, own.end}));
#pragma omp critical(granflux_fastest_particle)
    fastest = std::max(fastest, squared);
  });
  ahead_.clear();
  if (auto* own = dynamic_cast<Neighbor*>(neighbor))
    own->moved_at_most(dtv * std::sqrt(fastest));
}

double FixNveSphere::move(int halves, Range particles) const {
  return particles.size() > 0 ? kick_and_move(half_kick(), halves, dtv, spheres(), particles) : 0;
}

void FixNveSphere::move_ahead(int thread, Range particles) {
  Ahead& ahead = ahead_[std::size_t(thread)];
  particles.end = std::min(particles.end, count());
  if (particles.size() <= 0)
    return;
  ahead.fastest = std::max(ahead.fastest, move(2, particles));
  if (ahead.moved.size() == 0)
    ahead.moved.begin = particles.begin;
  ahead.moved.end = particles.end;
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
