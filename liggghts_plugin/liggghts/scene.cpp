// SPDX-FileCopyrightText: 2026 The GranFlux developers
// SPDX-License-Identifier: GPL-2.0-or-later

#include "scene.hpp"

#include <algorithm>
#include <span>
#include <string_view>

#include <fmt/core.h>
#include <mpi.h>

#include <liggghts/lammps.h>

#include <liggghts/atom.h>
#include <liggghts/domain.h>
#include <liggghts/fix_gravity.h>
#include <liggghts/modify.h>
#include <liggghts/update.h>

#include "driver/effects.hpp"

namespace granflux::liggghts {

namespace {

std::span<LAMMPS_NS::Fix*> fixes(LAMMPS_NS::LAMMPS& lammps) {
  return {lammps.modify->fix, std::size_t(lammps.modify->nfix)};
}

constexpr int shrink_wrapped = 2; // from here on in Domain::boundary
constexpr int minimisation = 2;   // in Update::whichflag

double largest_radius(LAMMPS_NS::LAMMPS& lammps) {
  double largest = 0;
  for (const double r : std::span(lammps.atom->radius, std::size_t(lammps.atom->nlocal)))
    largest = std::max(largest, r);
  MPI_Allreduce(MPI_IN_PLACE, &largest, 1, MPI_DOUBLE, MPI_MAX, lammps.world);
  return largest;
}

std::optional<Vec3> gravity(LAMMPS_NS::LAMMPS& lammps) {
  std::optional<Vec3> sum;
  for (LAMMPS_NS::Fix* fix : fixes(lammps)) {
    if (std::string_view(fix->style) != "gravity")
      continue;
    double g[3];
    static_cast<LAMMPS_NS::FixGravity*>(fix)->get_gravity(g);
    sum = sum.value_or(Vec3{}) + Vec3{g[0], g[1], g[2]};
  }
  return sum;
}

} // namespace

driver::Script script_of(LAMMPS_NS::LAMMPS& lammps) {
  driver::Script script{.units = lammps.update->unit_style,
                        .atom_style = lammps.atom->atom_style,
                        .run_style = lammps.update->integrate_style,
                        .radius_and_mass = lammps.atom->radius_flag && lammps.atom->rmass_flag,
                        .triclinic = lammps.domain->triclinic != 0,
                        .minimises = lammps.update->whichflag == minimisation,
                        .rigid_fix = {}};
  for (const LAMMPS_NS::Fix* fix : fixes(lammps)) {
    const std::string_view style = fix->style;
    if (style.starts_with("multisphere") || style.starts_with("rigid"))
      script.rigid_fix = fmt::format("fix {} (style {})", fix->id, style);
  }
  return script;
}

driver::Scene scene_of(LAMMPS_NS::LAMMPS& lammps) {
  const LAMMPS_NS::Domain& box = *lammps.domain;
  driver::Scene scene;
  for (std::size_t d = 0; d < 3; ++d) {
    scene.low[d] = box.boxlo[d];
    scene.high[d] = box.boxhi[d];
    scene.periodic[d] = box.periodicity[d] != 0;
    for (std::size_t side = 0; side < 2; ++side)
      scene.shrink_wrapped[d][side] = box.boundary[d][side] >= shrink_wrapped;
  }
  scene.largest_radius = largest_radius(lammps);
  scene.gravity = gravity(lammps);
  return scene;
}

void describe_particles(LAMMPS_NS::LAMMPS& lammps, coupling::SceneState& scene) {
  const LAMMPS_NS::Atom& atom = *lammps.atom;
  const auto n = std::size_t(atom.nlocal);
  const auto rows = [n](double** array) {
    return n ? std::span<const Vec3>(reinterpret_cast<const Vec3*>(array[0]), n)
             : std::span<const Vec3>();
  };
  driver::add_particles(scene,
                        {.position = rows(atom.x),
                         .velocity = rows(atom.v),
                         .radius = {atom.radius, n},
                         .mass = {atom.rmass, n}},
                        gravity(lammps).value_or(Vec3{}), lammps.world);
  for (int d = 0; d < 3; ++d)
    scene.box_length =
        std::max(scene.box_length, lammps.domain->boxhi[d] - lammps.domain->boxlo[d]);
}

} // namespace granflux::liggghts
