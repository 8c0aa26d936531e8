// SPDX-FileCopyrightText: 2026 The GranFlux developers
// SPDX-License-Identifier: BSD-3-Clause
//
// Closed forms of the numbers of a scene, worked by hand.

#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include <granflux/coupling/effects/numbers.hpp>

#include "scenes.hpp"

using namespace granflux::coupling;
using namespace granflux::testing;

namespace {

constexpr double exact = 1e-12;

double schiller_naumann(double re) {
  return 1 + 0.15 * std::pow(re, 0.687);
}

void near(double found, double wanted) {
  EXPECT_NEAR(found, wanted, exact * std::abs(wanted));
}

TEST(SceneNumbers, OfMotion) {
  const SceneState s = dust();
  const double re = 1.2 * 1e-4 / 1.8e-5,
               drag = 3 * std::numbers::pi * 1.8e-5 * 1e-4 * schiller_naumann(re);
  const double m = 2500 * std::numbers::pi / 6 * 1e-12;
  near(ParticleReynolds{}(s), re);
  near(StokesNumber{}(s), m / drag / 0.5);
  near(Froude{}(s), 1 / (9.81 * 1e-4));
  near(Archimedes{}(s), 1.2 * (2500 - 1.2) * 9.81 * 1e-12 / (1.8e-5 * 1.8e-5));
  near(DragOverWeight{}(s), drag / (m * (9.81 + 1 / 0.5)));
  near(AddedMass{}(s), 1.2 / 5000);
  near(PressureForce{}(s), 1.2 / 2500);
  near(Lift{}(s),
       1.615 * std::sqrt(1.2 * 1e-8 * 2 / 1.8e-5) / (3 * std::numbers::pi) * DragOverWeight{}(s));
  EXPECT_EQ(MassLoading{}(s), 0);
}

TEST(SceneNumbers, DragWithoutGravityIsOneOverStokes) {
  SceneState s = dust();
  s.gravity = 0;
  near(DragOverWeight{}(s), 1 / StokesNumber{}(s));
}

TEST(SceneNumbers, OfParcelsAreThoseOfTheirParticles) {
  const SceneState s = warm_dust();
  SceneState parcels = warm_dust();
  parcels.particles.diameter *= 3;
  parcels.gas->coarse_graining = 3;
  near(ParticleReynolds{}(parcels), ParticleReynolds{}(s));
  near(StokesNumber{}(parcels), StokesNumber{}(s));
  near(DragOverWeight{}(parcels), DragOverWeight{}(s));
  near(convection_conductance_of(parcels), 27 * convection_conductance_of(s));
}

TEST(SceneNumbers, OfCoupling) {
  SceneState s = dust();
  s.particles.solid_fraction = 1e-3;
  near(MassLoading{}(s), 1e-3 * 2500 / (0.999 * 1.2));
  near(MomentumCoupling{}(s), MassLoading{}(s) / (1 + StokesNumber{}(s)));
  const double drag = DragOverWeight{}(s);
  near(PressureForce{}(s), 1.2 / 2500 + drag * 1e-3 / 0.999);
}

TEST(SceneNumbers, OfHeat) {
  const SceneState s = warm_dust();
  const double d = 1e-4, t3 = 400. * 400 * 400;
  const double radiation = 4 * 0.8 * stefan_boltzmann * t3 * std::numbers::pi * d * d;
  const double re = ParticleReynolds{}(s), cube_root = std::cbrt(1.8e-5 * 1000 / 0.025);
  // Gunn at a void fraction of 1.
  const double nusselt =
      2 * (1 + 0.7 * std::pow(re, 0.2) * cube_root) + 0.13 * std::pow(re, 0.7) * cube_root;
  const double convection = std::numbers::pi * d * 0.025 * nusselt;
  // Gas at rest between particles far apart, and no collisions: no neighbours.
  const double all = radiation + convection;
  near(RadiationShare{}(s), radiation / all);
  near(ConvectionShare{}(s), convection / all);
  near(GasOverSolid{}(s), nusselt * 0.025);
  near(RadiationNumber{}(s), radiation / (std::numbers::pi * d));
  near(Biot{}(s), all / (std::numbers::pi * d / 2));
  EXPECT_EQ(ConductionShare{}(s), 0);
  EXPECT_EQ(GasGapShare{}(s), 0);
  near(ViscousHeating{}(s), 1.8e-5 / (0.025 * 100));
}

TEST(SceneNumbers, OfThermalBuoyancy) {
  SceneState s = warm_dust();
  s.gravity = 9.81;
  const double rise = 9.81 / 300 * 100;
  near(Richardson{}(s), rise * 0.5);
  near(Rayleigh{}(s), 1.2 * 1.2 * 1000 * rise * 0.125 / (1.8e-5 * 0.025));
  s.gas->speed = 0;
  near(Richardson{}(s), Rayleigh{}(s) / 1708);
}

TEST(SceneNumbers, ContactsOfAPacking) {
  SceneState s = warm_dust();
  s.gas.reset();
  s.gravity = 10;
  s.particles.solid_fraction = 0.6;
  s.particles.height = 100e-4;                             // 50 layers above the middle
  const double force = 50 * mass_of_one(s) * 10;           // N
  const double modulus = 4. / 3 * 7e10 / (2 * (1 - 0.04)); // Pa
  const double radius = std::cbrt(force * 0.25e-4 / modulus);
  near(contact_conductance_of(s), 6 * 2 * radius);
}

TEST(SceneNumbers, ContactsOfCollisions) {
  SceneState s = warm_dust();
  s.particles.solid_fraction = 0.01;
  s.particles.speed = 0.2;
  const double m = mass_of_one(s) / 2, r = 0.25e-4, modulus = 7e10 / (2 * (1 - 0.04));
  const double duration = 2.87 * std::pow(m * m / (r * modulus * modulus * 0.2), 0.2);
  const double often = 6 * 0.01 * 0.2 / 1e-4;
  const double radius = std::cbrt(2 * m * 0.2 / duration * r / (4. / 3 * modulus));
  near(contact_conductance_of(s), often * duration * 2 * radius);
  near(damping_power_of(s), m * 0.2 * 0.2 * often);
  near(friction_power_of(s), 2 * m * often * 0.2 * 0.2);
}

TEST(SceneNumbers, NothingIsDrivenAtOneTemperature) {
  SceneState s = warm_dust();
  s.hottest = s.coldest;
  for (const double share : {ConvectionShare{}(s), ConductionShare{}(s), GasGapShare{}(s),
                             RadiationShare{}(s), Biot{}(s)})
    EXPECT_EQ(share, 0);
}

TEST(SceneNumbers, WithoutGasNorTemperatures) {
  SceneState s = dust();
  s.gas.reset();
  for (const double number :
       {ParticleReynolds{}(s), StokesNumber{}(s), Archimedes{}(s), MassLoading{}(s), Rayleigh{}(s),
        GasOverSolid{}(s), RadiationNumber{}(s), DragOverWeight{}(s), PressureForce{}(s),
        MomentumCoupling{}(s), HeatCoupling{}(s), Richardson{}(s), ConvectionShare{}(s),
        FrictionOverHeat{}(s), DampingOverHeat{}(s), AddedMass{}(s), Lift{}(s),
        ViscousHeating{}(s)})
    EXPECT_EQ(number, 0);
}

} // namespace
