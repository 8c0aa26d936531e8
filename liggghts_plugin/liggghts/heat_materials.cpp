// SPDX-FileCopyrightText: 2026 The GranFlux developers
// SPDX-License-Identifier: GPL-2.0-or-later

#include "heat_materials.hpp"

#include <cmath>
#include <optional>

#include <fmt/core.h>

#include <liggghts/lammps.h>

#include <liggghts/atom.h>
#include <liggghts/fix_property_global.h>
#include <liggghts/force.h>
#include <liggghts/modify.h>
#include <liggghts/pair_gran.h>
#include <liggghts/properties.h>

#include <granflux/cfd/error.hpp>

namespace granflux::liggghts {

namespace {

/// Values of a property of each type, where the script has it.
std::optional<std::vector<double>> property(LAMMPS_NS::LAMMPS& lammps, const char* name) {
  auto* fix = lammps.modify->find_fix_property(name, "property/global", "peratomtype", 0, 0,
                                               "granflux/heat", false);
  if (!fix)
    return {};
  std::vector<double> values;
  const int types = lammps.atom->get_properties()->max_type(); // those in use
  for (int type = 0; type < types; ++type)
    values.push_back(fix->compute_vector(type));
  return values;
}

std::vector<double> positive_property(LAMMPS_NS::LAMMPS& lammps, const char* name,
                                      const char* unit) {
  const auto values = property(lammps, name);
  if (!values)
    throw ConfigError(
        fmt::format("needs fix property/global {} peratomtype, one value [{}] a type", name, unit));
  for (std::size_t type = 0; type < values->size(); ++type)
    if (!((*values)[type] > 0))
      throw ConfigError(fmt::format("{} of type {} is {}: must be above 0 {}", name, type + 1,
                                    (*values)[type], unit));
  return *values;
}

std::vector<double> emissivities(LAMMPS_NS::LAMMPS& lammps) {
  std::vector<double> values = positive_property(lammps, "emissivity", "from above 0 to 1");
  for (std::size_t type = 0; type < values.size(); ++type)
    if (values[type] > 1)
      throw ConfigError(
          fmt::format("emissivity of type {} is {}: must be at most 1", type + 1, values[type]));
  return values;
}

} // namespace

HeatMaterials read_heat_materials(LAMMPS_NS::LAMMPS& lammps, const driver::HeatOptions& wanted) {
  using particle_subset::FrictionHeat;
  const particle_subset::ContactHeatOptions& options = wanted.contacts;
  HeatMaterials read;
  if (wanted.near.surroundings)
    read.emissivity = emissivities(lammps);
  read.capacity = positive_property(lammps, "thermalCapacity", "J/(kg K)");
  const std::size_t types = read.capacity.size();
  const bool needs_conductivity =
      options.radius || options.friction != FrictionHeat::off || options.damping;
  const std::vector<double> conductivity =
      needs_conductivity ? positive_property(lammps, "thermalConductivity", "W/(m K)")
                         : std::vector<double>(types, 1);

  const bool needs_moduli =
      options.radius && std::visit([](const auto& r) { return r.needs_force; }, *options.radius);
  const auto softened = property(lammps, "youngsModulus"),
             original = property(lammps, "youngsModulusOriginal"),
             poisson = property(lammps, "poissonsRatio");
  if (needs_moduli && !original && !softened)
    throw ConfigError(
        "conduction hertz and geometric need fix property/global "
        "youngsModulusOriginal (or youngsModulus) peratomtype, the true modulus [Pa]");
  if (needs_moduli && !poisson)
    throw ConfigError(
        "conduction hertz and geometric need fix property/global poissonsRatio peratomtype");
  const std::vector<double> none(types, 1);
  const std::vector<double>& young = original ? *original : softened ? *softened : none;
  for (std::size_t type = 0; type < types; ++type)
    read.materials.push_back({conductivity[type], young[type], poisson ? (*poisson)[type] : 0});

  read.overlap_ratio.assign(types * types, 1);
  if (!softened || !original || !poisson)
    return read;
  // Under one force overlaps go with the modulus to the power of Hooke's law (-1) or Hertz's
  // (-2/3).
  auto* pair = dynamic_cast<LAMMPS_NS::PairGran*>(lammps.force->pair_match("gran", 0));
  const double exponent = pair ? 1 / pair->stressStrainExponent() : 0;
  const auto inverse = [&](const std::vector<double>& moduli, std::size_t a, std::size_t b) {
    return coupling::inverse_modulus(moduli[a], (*poisson)[a], moduli[b], (*poisson)[b]);
  };
  for (std::size_t a = 0; a < types; ++a)
    for (std::size_t b = 0; b < types; ++b)
      read.overlap_ratio[a * types + b] =
          std::pow(inverse(*original, a, b) / inverse(*softened, a, b), exponent);
  return read;
}

} // namespace granflux::liggghts
