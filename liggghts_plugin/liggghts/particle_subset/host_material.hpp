// SPDX-FileCopyrightText: 2026 The GranFlux developers
// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

#include <string>

#include <liggghts/lammps.h>

#include <liggghts/properties.h>
#include <liggghts/property_registry.h>

#include "gran_words.hpp"
#include "material.hpp"

namespace granflux::particle_subset {

/// Constants of the laws as LIGGGHTS derives them from the script's properties.
class HostMaterial : public Material {
public:
  /// `caller`: named where a property is missing.
  HostMaterial(PropertyRegistry& registry, const GranWords& words, const char* caller)
      : registry_(registry), words_(words), caller_(caller) {}
  [[nodiscard]] double pair(std::string_view property, int a, int b) const override {
    return registry_.getMatrixProperty(std::string(property), caller_)->data[a][b];
  }
  [[nodiscard]] double scalar(std::string_view property) const override {
    return registry_.getScalarProperty(std::string(property), caller_)->data;
  }
  [[nodiscard]] bool option(std::string_view keyword) const override {
    return words_.option(keyword);
  }

private:
  PropertyRegistry& registry_;
  const GranWords& words_;
  const char* caller_;
};

} // namespace granflux::particle_subset
