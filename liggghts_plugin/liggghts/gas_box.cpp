// SPDX-FileCopyrightText: 2026 The GranFlux developers
// SPDX-License-Identifier: GPL-2.0-or-later

#include "gas_box.hpp"

#include <algorithm>
#include <cmath>
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

#include <granflux/cfd/error.hpp>

namespace granflux::liggghts {

namespace {

std::span<LAMMPS_NS::Fix*> fixes(LAMMPS_NS::LAMMPS& lammps) {
  return {lammps.modify->fix, std::size_t(lammps.modify->nfix)};
}

constexpr char direction_name[] = {'x', 'y', 'z'};
constexpr int shrink_wrapped = 2; // from here on in Domain::boundary
constexpr int minimisation = 2;   // in Update::whichflag

} // namespace

void check_script(LAMMPS_NS::LAMMPS& lammps) {
  const std::string_view units = lammps.update->unit_style;
  if (units != "si")
    throw ConfigError(fmt::format("units {}: must be si", units));
  if (!lammps.atom->radius_flag || !lammps.atom->rmass_flag)
    throw ConfigError(fmt::format("atom_style {}: particles must have a radius and a mass "
                                  "(atom_style granular or sphere)",
                                  lammps.atom->atom_style));
  if (lammps.domain->triclinic)
    throw ConfigError("the simulation box is triclinic: it must be orthogonal");
  const std::string_view integrator = lammps.update->integrate_style;
  if (integrator.find("verlet") == std::string_view::npos)
    throw ConfigError(fmt::format("run_style {}: must be verlet", integrator));
  if (lammps.update->whichflag == minimisation)
    throw ConfigError("minimize does not move particles in time: unfix the gas before it");
  for (const LAMMPS_NS::Fix* fix : fixes(lammps)) {
    const std::string_view style = fix->style;
    if (style.starts_with("multisphere") || style.starts_with("rigid"))
      throw ConfigError(fmt::format("fix {} (style {}): rigid bodies of several spheres cannot be "
                                    "coupled",
                                    fix->id, style));
  }
}

void check_box(LAMMPS_NS::LAMMPS& lammps, const coupling::GridExtent& grid, bool is_box,
               double tolerance) {
  const LAMMPS_NS::Domain& box = *lammps.domain;
  for (std::size_t d = 0; d < 3; ++d) {
    const char name = direction_name[d];
    const double gas_lo = grid.low[int(d)], gas_hi = grid.high[int(d)];
    const bool box_periodic = box.periodicity[d] != 0;
    if (grid.periodic[d] != box_periodic)
      throw ConfigError(fmt::format("direction {} is {} for the gas grid, but {} for the "
                                    "simulation box (boundary command)",
                                    name, grid.periodic[d] ? "periodic" : "not periodic",
                                    box_periodic ? "periodic" : "not periodic"));
    if (!is_box && !box_periodic)
      continue;
    const auto compare = [&](const char* side, double gas, double particles, double allowed) {
      if (!(std::abs(gas - particles) <= allowed))
        throw ConfigError(fmt::format(
            "{} side in {}: the gas grid is at {} m, the simulation box at {} m; they may differ "
            "by {} m ({})",
            side, name, gas, particles, allowed,
            box_periodic ? "periodic: round-off" : "one particle diameter; 'box any' allows more"));
    };
    const double round_off = 1e-10 * (gas_hi - gas_lo);
    // A box that is still empty has no diameter to go by.
    const double allowed_here = box_periodic ? round_off : std::max(tolerance, round_off);
    if (box_periodic || box.boundary[d][0] < shrink_wrapped)
      compare("low", gas_lo, box.boxlo[d], allowed_here);
    if (box_periodic || box.boundary[d][1] < shrink_wrapped)
      compare("high", gas_hi, box.boxhi[d], allowed_here);
  }
}

double largest_radius(LAMMPS_NS::LAMMPS& lammps) {
  double largest = 0;
  for (const double r : std::span(lammps.atom->radius, std::size_t(lammps.atom->nlocal)))
    largest = std::max(largest, r);
  MPI_Allreduce(MPI_IN_PLACE, &largest, 1, MPI_DOUBLE, MPI_MAX, lammps.world);
  return largest;
}

std::string settle_gravity(LAMMPS_NS::LAMMPS& lammps, cfd::Fluid& fluid) {
  Vec3 script;
  bool found = false;
  for (LAMMPS_NS::Fix* fix : fixes(lammps)) {
    if (std::string_view(fix->style) != "gravity")
      continue;
    double g[3];
    static_cast<LAMMPS_NS::FixGravity*>(fix)->get_gravity(g);
    script += Vec3{g[0], g[1], g[2]};
    found = true;
  }
  if (!found && !fluid.gravity_given)
    return "no gravity: neither the script (fix gravity) nor the gas case gives any";
  if (!fluid.gravity_given) {
    fluid.gravity = script;
    return {};
  }
  if (found && norm(fluid.gravity - script) > 1e-6 * std::max(norm(fluid.gravity), norm(script)))
    throw ConfigError(fmt::format(
        "gravity of the gas case is ({}, {}, {}) m/s2, that of fix gravity ({}, {}, {}): they must "
        "agree; leave it out of the case to take the script's",
        fluid.gravity.x, fluid.gravity.y, fluid.gravity.z, script.x, script.y, script.z));
  return {};
}

} // namespace granflux::liggghts
