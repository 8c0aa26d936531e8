// SPDX-FileCopyrightText: 2026 The GranFlux developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <concepts>
#include <limits>
#include <string_view>

#include <granflux/coupling/effects/exchange_of_one.hpp>
#include <granflux/coupling/effects/scene_state.hpp>

// Dimensionless numbers of a scene. Each is a value with its name, its formula, its source and a
// call operator; 0 where the scene lacks what it is made of. Those that decide on an effect have
// the threshold above which the effect counts and the error that is made without it, relative to
// the force on a particle or to its heat (docs/effects.md).
namespace granflux::coupling {

template <class Number>
concept SceneNumber = requires(const Number number, const SceneState& scene) {
  { Number::name } -> std::convertible_to<std::string_view>;
  { Number::formula } -> std::convertible_to<std::string_view>;
  { Number::source } -> std::convertible_to<std::string_view>;
  { number(scene) } -> std::same_as<double>;
};

template <class Number>
concept DecidingNumber = SceneNumber<Number> && requires(double value) {
  { Number::threshold } -> std::convertible_to<double>;
  { Number::error(value) } -> std::same_as<double>;
};

/// Of what is left when a part n times as large as the rest is left out.
[[nodiscard]] constexpr double error_of_ratio(double n) {
  return n / (1 + n);
}
[[nodiscard]] constexpr double ratio(double a, double b) {
  return a == 0 ? 0 : b > 0 ? a / b : std::numeric_limits<double>::infinity();
}

/// Forces and motion: an effect of less than a hundredth is left out.
inline constexpr double force_threshold = 0.01;
/// Heat: temperatures that are one for a whole particle are exact to 5 % at a Biot number of 0.1.
inline constexpr double heat_threshold = 0.05;

// What the numbers that decide on an effect are of: where it counts, and the error without it.

/// A force, or what particles take out of the gas, over the rest.
struct ForceRatio {
  static constexpr double threshold = force_threshold;
  static constexpr double error(double n) { return error_of_ratio(n); }
};
/// Heat made over heat carried.
struct HeatRatio {
  static constexpr double threshold = heat_threshold;
  static constexpr double error(double n) { return error_of_ratio(n); }
};
/// One way for heat, of all.
struct ShareOfHeat {
  static constexpr double threshold = heat_threshold;
  static constexpr double error(double n) { return n; }
};

// Numbers that describe a scene.

struct ParticleReynolds {
  static constexpr std::string_view name = "particle Reynolds", formula = "rho eps |u-v| d / mu",
                                    source = "Gidaspow (1994)";
  double operator()(const SceneState& s) const { return reynolds_of(s); }
};

/// Response time of a particle over that of the flow.
struct StokesNumber {
  static constexpr std::string_view name = "Stokes", formula = "(m/b) |u-v| / L",
                                    source = "Crowe, Sommerfeld, Tsuji (1998)";
  double operator()(const SceneState& s) const {
    return s.gas ? ratio(mass_of_one(s) * slip_of(s), drag_coefficient_of(s) * s.gas->length) : 0;
  }
};

struct Froude {
  static constexpr std::string_view name = "Froude", formula = "U^2 / (g d)",
                                    source = "Geldart (1986)";
  double operator()(const SceneState& s) const {
    const double speed = std::max(s.particles.speed, s.gas ? s.gas->driven() : 0);
    return s.gravity > 0 ? ratio(speed * speed, s.gravity * s.particles.diameter) : 0;
  }
};

struct Archimedes {
  static constexpr std::string_view name = "Archimedes", formula = "rho |rho_p - rho| g d^3 / mu^2",
                                    source = "Geldart (1986)";
  double operator()(const SceneState& s) const {
    if (!s.gas)
      return 0;
    const double d = s.particles.diameter;
    return s.gas->density * std::abs(s.particles.density - s.gas->density) * s.gravity * d * d * d /
           (s.gas->viscosity * s.gas->viscosity);
  }
};

struct MassLoading {
  static constexpr std::string_view name = "mass loading", formula = "(1-eps) rho_p / (eps rho)",
                                    source = "Crowe, Sommerfeld, Tsuji (1998)";
  double operator()(const SceneState& s) const {
    return s.gas ? ratio(s.particles.solid_fraction * s.particles.density,
                         void_fraction_of(s) * s.gas->density)
                 : 0;
  }
};

struct Rayleigh {
  static constexpr std::string_view name = "Rayleigh", formula = "rho^2 cp g beta dT L^3 / (mu k)",
                                    source = "Incropera et al. (2007)";
  /// At which a layer heated from below begins to move.
  static constexpr double onset = 1708;
  double operator()(const SceneState& s) const {
    if (!s.gas || !(s.gas->conductivity > 0))
      return 0;
    const auto& g = *s.gas;
    return g.density * g.density * g.heat_capacity * s.gravity * g.expansion * s.span() * g.length *
           g.length * g.length / (g.viscosity * g.conductivity);
  }
};

/// What the gas conducts around a particle, over what the particle does inside.
struct GasOverSolid {
  static constexpr std::string_view name = "Nu k_gas/k_p", formula = "Nu k_gas / k_p",
                                    source = "Batchelor, O'Brien (1977)";
  double operator()(const SceneState& s) const {
    return s.heat ? ratio(convection_conductance_of(s),
                          std::numbers::pi * s.particles.diameter * s.heat->conductivity)
                  : 0;
  }
};

struct RadiationNumber {
  static constexpr std::string_view name = "radiation", formula = "4 e sigma T^3 d / k_p",
                                    source = "VDI Heat Atlas (2010), D6.3";
  double operator()(const SceneState& s) const {
    return s.heat ? ratio(radiation_conductance_of(s),
                          std::numbers::pi * s.particles.diameter * s.heat->conductivity)
                  : 0;
  }
};

// Numbers that decide.

/// Drag over weight; without gravity over inertia, which is one over the Stokes number.
struct DragOverWeight : ForceRatio {
  static constexpr std::string_view name = "drag / weight",
                                    formula = "b |u-v| / (m (g + |u-v|^2/L))",
                                    source = "1 % of the force";
  double operator()(const SceneState& s) const {
    if (!s.gas)
      return 0;
    const double slip = slip_of(s);
    return ratio(drag_coefficient_of(s) * slip,
                 mass_of_one(s) * (s.gravity + slip * slip / s.gas->length));
  }
};

/// Both phases bear the pressure gradient, that of the drag too: (1-eps)/eps of it.
struct PressureForce : ForceRatio {
  static constexpr std::string_view name = "pressure force / weight",
                                    formula = "rho/rho_p + drag/weight (1-eps)/eps",
                                    source = "Maxey, Riley (1983); 1 %";
  double operator()(const SceneState& s) const {
    if (!s.gas)
      return 0;
    return s.gas->density / s.particles.density +
           DragOverWeight{}(s)*s.particles.solid_fraction / void_fraction_of(s);
  }
};

/// Momentum that particles take out of the gas over what it has.
struct MomentumCoupling : ForceRatio {
  static constexpr std::string_view name = "momentum coupling",
                                    formula = "mass loading / (1 + Stokes)",
                                    source = "Crowe, Sommerfeld, Tsuji (1998); 1 %";
  double operator()(const SceneState& s) const {
    return MassLoading{}(s) / (1 + StokesNumber{}(s));
  }
};

/// Heat that particles take out of the gas over what it has.
struct HeatCoupling : ForceRatio {
  static constexpr std::string_view name = "heat coupling",
                                    formula = "mass loading c_p/c / (1 + m c_p |u-v| / (h A L))",
                                    source = "Crowe, Sommerfeld, Tsuji (1998); 1 %";
  double operator()(const SceneState& s) const {
    if (!s.heat || !s.gas || !(s.gas->heat_capacity > 0))
      return 0;
    const double response = ratio(mass_of_one(s) * s.heat->heat_capacity * slip_of(s),
                                  convection_conductance_of(s) * s.gas->length);
    return MassLoading{}(s)*s.heat->heat_capacity / s.gas->heat_capacity / (1 + response);
  }
};

/// Richardson; where nothing drives the gas, Rayleigh over that at which it begins to move.
struct Richardson {
  static constexpr std::string_view name = "Richardson",
                                    formula = "g beta dT L / U^2, at rest Ra/1708",
                                    source = "Incropera et al. (2007)";
  static constexpr double threshold = 0.1;
  static constexpr double error(double n) { return error_of_ratio(n); }
  double operator()(const SceneState& s) const {
    if (!s.gas || !(s.gas->conductivity > 0))
      return 0;
    const double speed = s.gas->driven();
    if (!(speed > 0))
      return Rayleigh{}(s) / Rayleigh::onset;
    return s.gravity * s.gas->expansion * s.span() * s.gas->length / (speed * speed);
  }
};

/// Share of one way for heat in all; 0 where all has one temperature.
[[nodiscard]] inline double share_of_heat(const SceneState& s, double conductance) {
  return s.span() > 0 ? ratio(conductance, conductance_of(s)) : 0;
}

struct ConvectionShare : ShareOfHeat {
  static constexpr std::string_view name = "convection / heat", formula = "h A / sum of H",
                                    source = "5 %, as Bi < 0.1: Incropera et al. (2007)";
  double operator()(const SceneState& s) const {
    return share_of_heat(s, convection_conductance_of(s));
  }
};

struct ConductionShare : ShareOfHeat {
  static constexpr std::string_view name = "contacts / heat", formula = "2 k_p r_c Z / sum of H",
                                    source = "Batchelor, O'Brien (1977); 5 %";
  double operator()(const SceneState& s) const {
    return share_of_heat(s, contact_conductance_of(s));
  }
};

struct GasGapShare : ShareOfHeat {
  static constexpr std::string_view name = "gas in gaps / heat", formula = "H_gap Z / sum of H",
                                    source = "Rong, Horio (1999); 5 %";
  double operator()(const SceneState& s) const { return share_of_heat(s, gap_conductance_of(s)); }
};

struct RadiationShare : ShareOfHeat {
  static constexpr std::string_view name = "radiation / heat",
                                    formula = "4 e sigma T^3 A / sum of H",
                                    source = "VDI Heat Atlas (2010), D6.3; 5 %";
  double operator()(const SceneState& s) const {
    return share_of_heat(s, radiation_conductance_of(s));
  }
};

/// Power that contacts make over what the differences of temperature drive; of those below 1 K
/// nothing is wanted. Where nothing carries heat away: what motion can warm a particle by, over 1
/// K.
[[nodiscard]] inline double made_over_driven(const SceneState& s, double power) {
  if (!s.heat || power == 0)
    return 0;
  const double span = std::max(1.0, s.span()), conductance = conductance_of(s);
  return conductance > 0
             ? power / (conductance * span)
             : s.particles.speed * s.particles.speed / (2 * s.heat->heat_capacity * span);
}

struct FrictionOverHeat : HeatRatio {
  static constexpr std::string_view name = "friction / heat", formula = "mu F v / (sum of H dT)",
                                    source = "5 %; differences from 1 K on";
  double operator()(const SceneState& s) const { return made_over_driven(s, friction_power_of(s)); }
};

struct DampingOverHeat : HeatRatio {
  static constexpr std::string_view name = "damping / heat", formula = "m v^2/2 f / (sum of H dT)",
                                    source = "5 %; differences from 1 K on";
  double operator()(const SceneState& s) const { return made_over_driven(s, damping_power_of(s)); }
};

// Numbers of what is not modelled.

/// All conductances to a particle over that of its inside, as biot_number().
struct Biot {
  static constexpr std::string_view name = "Biot", formula = "sum of H / (pi k_p R)",
                                    source = "Incropera et al. (2007)";
  static constexpr double threshold = 0.1;
  static constexpr double error(double n) { return error_of_ratio(n / 2); }
  double operator()(const SceneState& s) const {
    if (!s.heat || !(s.span() > 0))
      return 0;
    return ratio(conductance_of(s),
                 std::numbers::pi * s.heat->conductivity * s.particles.diameter / 2);
  }
};

struct AddedMass : ForceRatio {
  static constexpr std::string_view name = "added mass", formula = "rho / (2 rho_p)",
                                    source = "Maxey, Riley (1983); 1 %";
  double operator()(const SceneState& s) const {
    return s.gas ? s.gas->density / (2 * s.particles.density) : 0;
  }
};

/// Saffman's lift in the shear U/L, over the weight as DragOverWeight.
struct Lift : ForceRatio {
  static constexpr std::string_view name = "lift / weight",
                                    formula = "1.615 (rho d^2 U/(L mu))^(1/2)/(3 pi) drag/weight",
                                    source = "Saffman (1965); 1 %";
  double operator()(const SceneState& s) const {
    if (!s.gas)
      return 0;
    const double d = s.particles.diameter, shear = s.gas->driven() / s.gas->length;
    return 1.615 * std::sqrt(s.gas->density * d * d * shear / s.gas->viscosity) /
           (3 * std::numbers::pi) * DragOverWeight{}(s);
  }
};

/// Brinkman number, Eckert times Prandtl, with differences of temperature from 1 K on.
struct ViscousHeating : HeatRatio {
  static constexpr std::string_view name = "Brinkman", formula = "mu U^2 / (k dT)",
                                    source = "Bird, Stewart, Lightfoot (2002); 5 %";
  double operator()(const SceneState& s) const {
    if (!s.gas || !(s.gas->conductivity > 0))
      return 0;
    const double speed = std::max(s.gas->driven(), slip_of(s));
    return s.gas->viscosity * speed * speed / (s.gas->conductivity * std::max(1.0, s.span()));
  }
};

} // namespace granflux::coupling
