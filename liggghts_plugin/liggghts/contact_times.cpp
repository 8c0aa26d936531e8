// SPDX-FileCopyrightText: 2026 The GranFlux developers
// SPDX-License-Identifier: GPL-2.0-or-later

#include "contact_times.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include <mpi.h>

#include <liggghts/lammps.h>

#include <liggghts/atom.h>
#include <liggghts/fix.h>
#include <liggghts/force.h>
#include <liggghts/modify.h>
#include <liggghts/properties.h>

#include "particle_subset/normal_law.hpp"
#include "particle_subset/pair_gran.hpp"

namespace granflux::liggghts {

namespace {

/// Radius and mass of the smallest of each type, with its moduli where the script has them.
std::vector<driver::ParticleType> types_of(LAMMPS_NS::LAMMPS& lammps) {
  LAMMPS_NS::Atom& atom = *lammps.atom;
  const auto types = std::size_t(std::max(atom.get_properties()->max_type(), 0));
  constexpr double none = std::numeric_limits<double>::max();
  std::vector<double> least(2 * types, none);
  for (int i = 0; i < atom.nlocal; ++i) {
    const auto type = std::size_t(atom.type[i]) - 1;
    least[2 * type] = std::min(least[2 * type], atom.radius[i]);
    least[2 * type + 1] = std::min(least[2 * type + 1], atom.rmass[i]);
  }
  MPI_Allreduce(MPI_IN_PLACE, least.data(), int(least.size()), MPI_DOUBLE, MPI_MIN, lammps.world);
  const auto property = [&](const char* name) {
    return lammps.modify->find_fix_property(name, "property/global", "peratomtype", 0, 0,
                                            "granflux/couple", false);
  };
  LAMMPS_NS::Fix *young = property("youngsModulus"), *poisson = property("poissonsRatio");
  std::vector<driver::ParticleType> found(types);
  for (std::size_t type = 0; type < types; ++type) {
    if (least[2 * type] == none)
      continue;
    found[type].least_radius = least[2 * type];
    found[type].least_mass = least[2 * type + 1];
    if (young && poisson) {
      found[type].young = young->compute_vector(int(type));
      found[type].poisson = poisson->compute_vector(int(type));
    }
  }
  return found;
}

/// What the law's force goes with: asked at a small overlap, at rest and while it grows.
driver::NormalSpring spring_of(const particle_subset::PairGran& pair, int a, int b, double radius,
                               double mass) {
  particle_subset::Contact contact{};
  contact.reduced_radius = radius;
  contact.reduced_mass = mass;
  contact.radius_i = contact.radius_j = 2 * radius;
  contact.overlap = 1e-3 * radius;
  contact.distance = 4 * radius - contact.overlap;
  const double at_rest = pair.normal_force(a, b, contact)->force;
  if (particle_subset::is_hertzian(pair.normal_law()))
    return {.hertzian = true,
            .stiffness = at_rest / (std::sqrt(radius * contact.overlap) * contact.overlap)};
  contact.normal_speed = -1; // towards each other
  return {.stiffness = at_rest / contact.overlap,
          .damping = pair.normal_force(a, b, contact)->force - at_rest};
}

} // namespace

driver::ContactTimes contact_times_of(LAMMPS_NS::LAMMPS& lammps) {
  const std::vector<driver::ParticleType> types = types_of(lammps);
  auto* pair = dynamic_cast<particle_subset::PairGran*>(lammps.force->pair_match("gran", 0));
  std::string unknown;
  if (!pair)
    unknown = "the pair style is not the launcher's gran";
  else if (!pair->normal_force(1, 1, {}))
    unknown = "model " + pair->normal_law() + " or an option of it tells no stiffness";
  driver::ContactTimes times = driver::shortest_times(types, [&](int a, int b, double r, double m) {
    return unknown.empty() ? spring_of(*pair, a, b, r, m) : driver::NormalSpring{};
  });
  times.unknown = unknown;
  return times;
}

} // namespace granflux::liggghts
