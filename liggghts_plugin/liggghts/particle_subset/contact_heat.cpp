// SPDX-FileCopyrightText: 2026 The GranFlux developers
// SPDX-License-Identifier: GPL-2.0-or-later

#include "contact_heat.hpp"

#include <omp.h>

#include <granflux/coupling/contact_heat/conductance.hpp>

namespace granflux::particle_subset {

HeatSums& HeatSums::operator+=(const HeatSums& o) & {
  conduction += o.conduction;
  friction += o.friction;
  damping += o.damping;
  walls += o.walls;
  to_walls += o.to_walls;
  radiation += o.radiation;
  return *this;
}

void HeatArrays::add_made(int p, double friction, double damping, HeatSums& of_thread) const {
  if (kept.now) {
    if (kept.friction)
      kept.friction[p] += kept.dt * friction;
    if (kept.damping)
      kept.damping[p] += kept.dt * damping;
    return;
  }
  const double by_friction = part_of_step * friction, by_damping = part_of_step * damping;
  rate[p] += by_friction + by_damping;
  of_thread.friction += by_friction;
  of_thread.damping += by_damping;
  if (!shown.wanted())
    return;
  shown.contacts[p].made += by_friction + by_damping;
  shown.details[p].friction += by_friction;
  shown.details[p].damping += by_damping;
}

ContactHeat::ContactHeat(const ContactHeatOptions& options,
                         std::span<const ThermalMaterial> materials,
                         std::span<const double> overlap_ratio)
    : options_(options), types_(int(materials.size())) {
  auto ratio = overlap_ratio.begin();
  for (const ThermalMaterial& a : materials)
    for (const ThermalMaterial& b : materials)
      pairs_.push_back(
          {.conductance_per_radius =
               coupling::conductance_per_radius(a.conductivity, b.conductivity),
           .inverse_modulus = coupling::inverse_modulus(a.young, a.poisson, b.young, b.poisson),
           .overlap_ratio = *ratio++,
           .share = coupling::heat_share(a.conductivity, b.conductivity)});
}

bool ContactHeat::needs_no_force() const {
  return !options_.radius ||
         std::visit([](const auto& radius) { return !radius.needs_force; }, *options_.radius);
}

double ContactHeat::conductance(const PairConstants& pair, double radius_i, double radius_j,
                                double overlap, double force) const {
  if (!options_.radius)
    return 0;
  const coupling::ContactShape shape =
      coupling::shape_of_pair(radius_i, radius_j, pair.overlap_ratio * overlap, force);
  return std::visit(
      [&](const auto& radius) {
        return pair.conductance_per_radius * radius(pair.inverse_modulus, shape);
      },
      *options_.radius);
}

double ContactHeat::conductance_at_wall(const PairConstants& pair, double radius, double overlap,
                                        double force) const {
  if (!options_.radius)
    return 0;
  const coupling::ContactShape shape =
      coupling::shape_at_wall(radius, pair.overlap_ratio * overlap, force);
  return std::visit(
      [&](const auto& r_c) {
        return pair.conductance_per_radius * r_c(pair.inverse_modulus, shape);
      },
      *options_.radius);
}

void HeatOfWall::add(int p, int type, int wall_type, double radius, double overlap, double force,
                     const Dissipation& made) const {
  const ContactHeat& law = *contacts.law;
  const bool conducts = temperature && !contacts.arrays.kept.now;
  const double conductance =
      conducts ? law.conductance_at_wall(law.pair(type, wall_type), radius, overlap, force) : 0;
  const double conduction =
      conducts ? conductance * (*temperature - contacts.arrays.temperature[p]) : 0;
  give(p, conduction, conductance, law.friction(made), law.options().damping ? made.damping : 0);
}

void HeatOfWall::add_parted(int p, double power) const {
  if (contacts.law->options().friction != FrictionHeat::off)
    give(p, 0, 0, power, 0);
}

void HeatOfWall::give(int p, double conduction, double conductance, double all_friction,
                      double all_damping) const {
  const HeatArrays& arrays = contacts.arrays;
  HeatSums& sums = arrays.sums[omp_get_thread_num()];
  const double share = contacts.law->options().wall_share;
  const double to_wall = share * (all_friction + all_damping);
  sums.to_walls += to_wall;
  arrays.add_made(p, (1 - share) * all_friction, (1 - share) * all_damping, sums);
  if (arrays.kept.now)
    return;
  arrays.rate[p] += conduction;
  sums.walls += conduction;

  if (!arrays.shown.wanted())
    return;
  arrays.shown.details[p].conductance += conductance;
  WallHeatRates& walls = arrays.shown.walls[p];
  walls.conduction += conduction;
  walls.to_wall += to_wall;
}

} // namespace granflux::particle_subset
