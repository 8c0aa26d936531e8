// SPDX-FileCopyrightText: 2026 The GranFlux developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <granflux/coupling/effects/scene_state.hpp>

// Scenes whose numbers and decisions are known.
namespace granflux::testing {

inline coupling::HeatOfScene glass(double heat_capacity) {
  return {.heat_capacity = heat_capacity, .conductivity = 1, .young = 7e10, .poisson = 0.2};
}

/// 0.1 mm glass in air at 1 m/s, far from each other.
inline coupling::SceneState dust() {
  coupling::SceneState s;
  s.particles = {.count = 1000,
                 .diameter = 1e-4,
                 .density = 2500,
                 .speed = 0,
                 .solid_fraction = 0,
                 .height = 0.1};
  s.gas = coupling::GasOfScene{.density = 1.2, .viscosity = 1.8e-5, .speed = 1, .length = 0.5};
  s.gravity = 9.81;
  return s;
}

/// The same warm, without gravity.
inline coupling::SceneState warm_dust() {
  coupling::SceneState s = dust();
  s.gravity = 0;
  s.gas->conductivity = 0.025;
  s.gas->heat_capacity = 1000;
  s.gas->expansion = 1. / 300;
  s.heat = glass(800);
  s.heat->emissivity = 0.8;
  s.meets(300);
  s.meets(400);
  return s;
}

/// Dust of 1000 K in air of 300 K that carries one particle to a litre.
inline coupling::SceneState hot_dilute() {
  coupling::SceneState s = dust();
  s.particles.count = 1e4;
  s.particles.speed = 1;
  s.particles.solid_fraction = 1e-7;
  s.particles.height = 0.5;
  s.gas->speed = 5;
  s.gas->length = 1;
  s.gas->slip = 1;
  s.gas->conductivity = 0.026;
  s.gas->heat_capacity = 1006;
  s.gas->expansion = 1. / 300;
  s.heat = glass(840);
  s.meets(300);
  s.meets(1000);
  return s;
}

/// The paper's small bed, fluidised by air, all of one temperature.
inline coupling::SceneState cold_bed() {
  coupling::SceneState s = dust();
  s.particles = {.count = 9240,
                 .diameter = 1.2e-3,
                 .density = 1000,
                 .speed = 0.1,
                 .solid_fraction = 0.6,
                 .height = 0.03};
  s.gas->speed = 0.9;
  s.gas->length = 0.12;
  s.gas->conductivity = 0.026;
  s.gas->heat_capacity = 1006;
  s.heat = glass(800);
  s.meets(300);
  return s;
}

/// The paper's kiln section: alumina of 2 mm, a wall of 373 K, air at rest.
inline coupling::SceneState kiln() {
  coupling::SceneState s;
  s.particles = {.count = 20000,
                 .diameter = 2e-3,
                 .density = 3900,
                 .speed = 0.05,
                 .solid_fraction = 0.6,
                 .height = 0.076};
  s.heat = coupling::HeatOfScene{
      .heat_capacity = 875, .conductivity = 36, .young = 193.05e9, .poisson = 0.3};
  s.gravity = 9.81;
  s.meets(298);
  s.meets(373);
  return s;
}

} // namespace granflux::testing
