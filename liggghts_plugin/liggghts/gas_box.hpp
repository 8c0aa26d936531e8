// SPDX-FileCopyrightText: 2026 The GranFlux developers
// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

#include <string>

#include <granflux/cfd/gas_case.hpp>
#include <granflux/coupling/grid_extent.hpp>

namespace LAMMPS_NS {
class LAMMPS;
}

namespace granflux::liggghts {

/// The script must be one that can be coupled: units si, spheres with radius and mass, an
/// orthogonal box, plain Verlet steps, no rigid clumps, no minimisation. Throws ConfigError.
void check_script(LAMMPS_NS::LAMMPS& lammps);

/// The gas grid against the simulation box: periodic directions and lengths must agree, other
/// sides, where the grid `is_box`, within `tolerance` [m] (shrink-wrapped sides are the particles'
/// and are not compared). Throws ConfigError.
void check_box(LAMMPS_NS::LAMMPS& lammps, const coupling::GridExtent& grid, bool is_box,
               double tolerance);

/// Radius of the largest particle on any rank [m]; 0 without particles. Collective.
double largest_radius(LAMMPS_NS::LAMMPS& lammps);

/// Sum of the script's `fix gravity` commands, if there is one, becomes the gravity of a case that
/// gives none. Returns a note for the user where neither gives any, else an empty text. Throws
/// ConfigError where both do and differ by more than 1e-6.
std::string settle_gravity(LAMMPS_NS::LAMMPS& lammps, cfd::Fluid& fluid);

} // namespace granflux::liggghts
