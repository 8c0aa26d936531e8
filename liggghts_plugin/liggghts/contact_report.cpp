// SPDX-FileCopyrightText: 2026 The GranFlux developers
// SPDX-License-Identifier: GPL-2.0-or-later

#include "contact_report.hpp"

#include <algorithm>
#include <cmath>
#include <set>

#include <fmt/core.h>
#include <mpi.h>

#include <liggghts/lammps.h>

#include <liggghts/atom.h>
#include <liggghts/modify.h>
#include <liggghts/update.h>

#include "contact_times.hpp"
#include "driver/particle_bounds.hpp"

namespace granflux::liggghts {

std::string contact_report(LAMMPS_NS::LAMMPS& lammps) {
  const LAMMPS_NS::Atom& atom = *lammps.atom;
  if (lammps.modify->n_fixes_style("granflux/couple") > 0 || !atom.radius_flag || !atom.rmass_flag)
    return {};
  double largest[2] = {0, 0}; // speed, its share of a radius
  for (int i = 0; i < atom.nlocal; ++i) {
    const double* v = atom.v[i];
    const double speed = std::hypot(v[0], v[1], v[2]);
    largest[0] = std::max(largest[0], speed);
    largest[1] = std::max(largest[1], speed / atom.radius[i]);
  }
  MPI_Allreduce(MPI_IN_PLACE, largest, 2, MPI_DOUBLE, MPI_MAX, lammps.world);
  const driver::ContactTimes times = contact_times_of(lammps);
  if (times.least_radius == 0)
    return {};
  cfd::StableRange range;
  driver::ParticleBounds bounds(range);
  bounds.set(times, lammps.update->dt, largest[0], largest[1]);
  // Once for a time step and what it is worth, not for every change of a speed.
  static std::set<std::string> told;
  std::string verdict = fmt::format("{}", lammps.update->dt);
  for (std::size_t row = 0; row < range.size(); ++row)
    verdict += name_of(range.standing(row));
  if (!told.insert(verdict).second)
    return {};
  std::string text = range.table("stable range");
  text.pop_back(); // the line ends where it is said
  return text;
}

} // namespace granflux::liggghts
