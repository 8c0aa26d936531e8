// SPDX-FileCopyrightText: 2026 The GranFlux developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <optional>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include <granflux/cfd/annulus_grid.hpp>
#include <granflux/cfd/box_mesh.hpp>
#include <granflux/cfd/cgns_reader.hpp>
#include <granflux/cfd/cylinder_grid.hpp>
#include <granflux/cfd/error.hpp>
#include <granflux/cfd/pressure_solver.hpp>

namespace granflux::cfd {

/// What a grid is made from; make_mesh in case_mesh.hpp makes it.
using GridDescription = std::variant<BoxGrid, AnnulusGrid, CylinderGrid, CgnsGrid>;

struct Fluid {
  double density = 1.2;      ///< kg/m3
  double viscosity = 1.8e-5; ///< dynamic viscosity, Pa s
  /// m/s2. Constant density makes the hydrostatic part exact: the solver carries the dynamic
  /// pressure p - rho g.x, and particles feel -rho V g beside its gradient.
  Vec3 gravity{};
  bool gravity_given = false;       ///< false: a host may supply its own
  Vec3 driving_pressure_gradient{}; ///< imposed mean of grad p [Pa/m], for periodic directions
  /// Smagorinsky's constant; 0: no eddy viscosity.
  double smagorinsky = 0;
};

/// Temperature of the gas, with constant properties.
struct Energy {
  double heat_capacity = 1006;         ///< cp, J/(kg K)
  double conductivity = 0.026;         ///< k, W/(m K)
  double initial_temperature = 293.15; ///< K
  /// Boussinesq: density falls by this share a kelvin in the weight only [1/K]; 0: no buoyancy.
  double expansion = 0;
  double reference_temperature = 293.15; ///< at which the gas has Fluid::density [K]
};

enum class BoundaryKind { inlet, outlet, wall, slip };

struct BoundaryCondition {
  std::string name; ///< that of the mesh's boundary
  BoundaryKind kind = BoundaryKind::wall;
  /// Inlet: superficial velocity (volume flux per area, void fraction included) [m/s], the mean of
  /// the profile. Wall: velocity of the wall, tangential [m/s].
  Vec3 velocity{};
  enum class Profile { uniform, parabolic } profile = Profile::uniform;
  double ramp_time = 0;    ///< s; the inlet velocity grows linearly from ramp_from * velocity
  double ramp_from = 0;    ///< share of the velocity at time 0
  double pressure = 0;     ///< outlet: dynamic pressure at the face [Pa]
  Vec3 angular_velocity{}; ///< wall: turns about an axis through `centre` [rad/s]
  Vec3 centre{};           ///< m
  enum class Heat { adiabatic, temperature, flux } heat = Heat::adiabatic;
  /// Inlet, or wall of given temperature; outlet: of gas that flows back [K].
  double temperature = 293.15;
  double heat_flux = 0; ///< wall: into the gas, per area of the wall [W/m2]
};

enum class ConvectionScheme { central, upwind2, limited };

enum class TimeScheme {
  semi_implicit, ///< Adams-Bashforth for convection, Crank-Nicolson for diffusion
  implicit       ///< Crank-Nicolson for both, iterated with the pressure to convergence
};

struct Numerics {
  ConvectionScheme convection = ConvectionScheme::limited;
  TimeScheme time_scheme = TimeScheme::semi_implicit;
  /// Implicit scheme: remaining defect of the momentum equation, relative to its terms.
  double implicit_tolerance = 1e-8;
  /// Further pressure solutions a step that bring the non-orthogonal part of the pressure's
  /// gradient up to date; it is one step old otherwise. Orthogonal meshes need none.
  int pressure_corrections = 0;
  PressureMethod pressure_solver = PressureMethod::automatic;
  double pressure_tolerance = 1e-10; ///< of the residual, relative to the right-hand side
  double viscous_tolerance = 1e-10;
  double time_step = 0; ///< s; for a run without particles: the largest, where courant is given
  double courant = 0;   ///< likewise: the time step follows this Courant number; 0: it is fixed
  double end_time = 0;  ///< s; likewise
};

struct Output {
  std::string fields;          ///< path of the CGNS files without ending; empty: none
  double every = 0;            ///< s of simulated time between two of them
  std::string checkpoint;      ///< path of the file that a run can be continued from; empty: none
  double checkpoint_every = 0; ///< s of simulated time; 0: at the end only
};

/// All that defines a gas run. Plain data; read_gas_case fills it from a TOML file.
struct GasCase {
  GridDescription grid;
  Fluid fluid;
  std::optional<Energy> energy; ///< not set: no temperature is solved for
  std::vector<BoundaryCondition> boundaries;
  Numerics numerics;
  Output output;
  Vec3 initial_velocity{};
};

/// The box of a case that must have one. Throws ConfigError where the grid is of another kind.
[[nodiscard]] inline const BoxGrid& box_grid(const GasCase& gas_case) {
  if (const auto* box = std::get_if<BoxGrid>(&gas_case.grid))
    return *box;
  throw ConfigError("[grid] kind: must be \"box\" for a case with particles: they are located on "
                    "straight boxes of cells only");
}
[[nodiscard]] inline BoxGrid& box_grid(GasCase& gas_case) {
  return const_cast<BoxGrid&>(box_grid(std::as_const(gas_case)));
}

} // namespace granflux::cfd
