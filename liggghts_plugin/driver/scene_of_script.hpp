// SPDX-FileCopyrightText: 2026 The GranFlux developers
// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

#include <algorithm>
#include <mpi.h>
#include <optional>
#include <span>
#include <string>

#include <granflux/coupling/effects/scene_state.hpp>

#include "effects.hpp"
#include "rows_of.hpp"
#include "scene.hpp"

namespace granflux::driver {

// Over the host's class LAMMPS, whose parts have the same names in all of them.

/// `rigid_fix`: "fix ID (style STYLE)" of one that holds spheres together, or empty.
template <class Lammps> Script script_of(const Lammps& lammps, const std::string& rigid_fix) {
  constexpr int minimisation = 2; // in Update::whichflag
  return {.units = lammps.update->unit_style,
          .atom_style = lammps.atom->atom_style,
          .run_style = lammps.update->integrate_style,
          .radius_and_mass = lammps.atom->radius_flag && lammps.atom->rmass_flag,
          .triclinic = lammps.domain->triclinic != 0,
          .minimises = lammps.update->whichflag == minimisation,
          .rigid_fix = rigid_fix};
}

/// Collective.
template <class Lammps> double largest_radius(const Lammps& lammps) {
  double largest = 0;
  for (const double r : std::span(lammps.atom->radius, std::size_t(lammps.atom->nlocal)))
    largest = std::max(largest, r);
  MPI_Allreduce(MPI_IN_PLACE, &largest, 1, MPI_DOUBLE, MPI_MAX, lammps.world);
  return largest;
}

/// `gravity`: the sum of the script's constant ones, if it has any [m/s2]. Collective.
template <class Lammps> Scene scene_of(const Lammps& lammps, const std::optional<Vec3>& gravity) {
  constexpr int shrink_wrapped = 2; // from here on in Domain::boundary
  const auto& box = *lammps.domain;
  Scene scene;
  for (std::size_t d = 0; d < 3; ++d) {
    scene.low[d] = box.boxlo[d];
    scene.high[d] = box.boxhi[d];
    scene.periodic[d] = box.periodicity[d] != 0;
    for (std::size_t side = 0; side < 2; ++side)
      scene.shrink_wrapped[d][side] = box.boundary[d][side] >= shrink_wrapped;
  }
  scene.largest_radius = largest_radius(lammps);
  scene.gravity = gravity;
  return scene;
}

/// The particles of the script, its gravity and its box. Collective.
template <class Lammps>
void describe_particles(const Lammps& lammps, const std::optional<Vec3>& gravity,
                        coupling::SceneState& scene) {
  const auto& atom = *lammps.atom;
  const auto n = std::size_t(atom.nlocal);
  add_particles(scene,
                {.position = rows_of<const Vec3>(atom.x, n),
                 .velocity = rows_of<const Vec3>(atom.v, n),
                 .radius = {atom.radius, n},
                 .mass = {atom.rmass, n}},
                gravity.value_or(Vec3{}), lammps.world);
  for (int d = 0; d < 3; ++d)
    scene.box_length =
        std::max(scene.box_length, lammps.domain->boxhi[d] - lammps.domain->boxlo[d]);
}

} // namespace granflux::driver
