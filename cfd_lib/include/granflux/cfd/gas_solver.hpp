// SPDX-FileCopyrightText: 2026 The GranFlux developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include <granflux/cfd/gas_case.hpp>
#include <granflux/cfd/mesh.hpp>
#include <granflux/cfd/state_record.hpp>

namespace granflux::cfd {

/// What a second phase does to the gas over one step, per unit of volume, on interior cells. The
/// momentum it gives to the gas is
///   drag_source - drag_coefficient * u  +  (1 - pressure_fraction) * grad p    [N/m3]
/// with u and p at the end of the step (the coefficient is taken implicitly, in the predictor and
/// in the pressure equation).
struct MomentumExchange {
  BlockFields drag_coefficient; ///< beta >= 0 [kg/(m3 s)]
  BlockVectors drag_source;     ///< [N/m3]
  /// Share of the pressure gradient that the gas bears: the void fraction in model A, 1 in model B.
  BlockFields pressure_fraction;
};
MomentumExchange make_exchange(const Mesh& mesh);

/// Heat that a second phase gives to the gas over one step, per unit of volume, on interior cells:
/// source - coefficient * T [W/m3], with T at the end of the step (implicit).
struct HeatExchange {
  BlockFields coefficient; ///< >= 0 [W/(m3 K)]
  BlockFields source;      ///< [W/m3]
};

/// Integrals over all blocks and all ranks of the terms of the last step; equal on every rank.
struct Balance {
  double gas_volume_change = 0;        ///< d(sum eps V)/dt [m3/s]
  double boundary_volume_flux = 0;     ///< out of the domain [m3/s]
  Vec3 momentum;                       ///< of the gas at the end of the step [kg m/s]
  Vec3 momentum_change;                ///< rate over the step [N]
  Vec3 convection, friction, pressure; ///< through the boundaries, into the gas [N]
  Vec3 driving;                        ///< of the driving pressure gradient [N]
  Vec3 exchange;                       ///< from the second phase [N]
  /// momentum_change - convection - friction - pressure - driving - exchange - thermal_buoyancy [N]
  Vec3 momentum_residual;
  /// sum of the magnitudes of the terms above: what the residual is to be measured by [N]
  double momentum_scale = 0;
  Vec3 thermal_buoyancy; ///< Boussinesq force [N]
  // Energy, where it is solved [W]: rate of change of sum rho cp eps T V; through the boundaries by
  // flow and by conduction, and from the second phase, all into the gas; what is left of it.
  double heat_change = 0, heat_convection = 0, heat_conduction = 0, heat_exchange = 0;
  double heat_residual = 0;
  double heat_scale = 0; ///< sum of the magnitudes of the terms, and of rho cp eps T V / dt
};

struct StepReport {
  double continuity_residual = 0; ///< largest |d eps/dt + div(eps u)| of a cell [1/s]
  double continuity_scale = 0;    ///< largest sum of |fluxes| over volume of a cell [1/s]
  int pressure_iterations = 0;    ///< 0 for a direct solve
  double pressure_residual = 0;   ///< relative
  int viscous_iterations = 0;     ///< most of the three components
  int outer_iterations = 0;       ///< of the implicit scheme; 0 for the semi-implicit one
  double courant = 0;             ///< largest, by face fluxes and void fraction
  /// The void fraction jumped so far that extrapolating it would have left the gas without
  /// inertia somewhere: the time history was begun anew (first order for this one step).
  bool history_restarted = false;
};

/// Volume-averaged incompressible Navier-Stokes, and the energy equation where asked for, on a
/// multi-block mesh: collocated finite volumes, fractional step, Adams-Bashforth convection,
/// Crank-Nicolson diffusion (docs/theory.md).
class GasSolver {
public:
  /// Throws ConfigError where a boundary of the mesh has no condition or a condition no boundary.
  GasSolver(const Mesh& mesh, const GasCase& gas_case);
  ~GasSolver();
  GasSolver(const GasSolver&) = delete;
  GasSolver& operator=(const GasSolver&) = delete;

  /// Void fraction before the first step. Restarts the solver's history: the initial velocity is
  /// made to satisfy continuity. Collective.
  void initialise(const BlockFields& void_fraction, const BlockVectors& velocity, double time = 0);
  void initialise(const BlockFields& void_fraction, Vec3 velocity, double time = 0);

  /// One step of dt. `void_fraction` is that at the end of the step; `exchange` may be null for a
  /// gas alone. Collective. Throws NumericalError, with the cell where one can be named:
  /// not-a-number, a solver that does not converge, a Courant number beyond hopeless_courant().
  StepReport advance(double dt, const BlockFields& void_fraction, const MomentumExchange* exchange,
                     const HeatExchange* heat = nullptr);

  [[nodiscard]] double time() const; ///< s
  [[nodiscard]] long steps() const;
  [[nodiscard]] const BlockVectors& velocity() const; ///< interstitial [m/s], ghosts filled
  [[nodiscard]] const BlockFields& pressure() const;  ///< dynamic [Pa], ghosts filled
  [[nodiscard]] const BlockVectors& pressure_gradient() const; ///< driving part included [Pa/m]
  [[nodiscard]] const BlockFields& void_fraction() const;      ///< at the end of the last step
  /// At the end of the last step [K]; null where the case has no energy equation.
  [[nodiscard]] const BlockFields* temperature() const;
  /// Sets it on interior cells, instead of the case's initial value, after initialise().
  /// Collective.
  void set_temperature(const BlockFields& temperature);
  [[nodiscard]] const Balance& balance() const;
  [[nodiscard]] const Mesh& mesh() const;
  [[nodiscard]] const Fluid& fluid() const;

  /// Area-weighted mean of the dynamic pressure on a boundary [Pa]. Collective.
  [[nodiscard]] double boundary_pressure(const std::string& boundary) const;
  /// Volume flux out of the domain through a boundary [m3/s]. Collective.
  [[nodiscard]] double boundary_flux(const std::string& boundary) const;
  /// Force of the gas on a boundary [N]: dynamic pressure and friction, by the whole stress
  /// mu (grad u + transposed), with the fields as they are. Collective. Throws ConfigError for a
  /// name that the gas has no boundary of.
  [[nodiscard]] Vec3 boundary_force(const std::string& boundary) const;

  /// Largest friction number nu dt sum(1/h2) per time [1/s]. Friction is implicit: the number does
  /// not limit the step, but above 1 the shortest waves no longer fade as they should. Collective.
  [[nodiscard]] double friction_rate() const;

  /// Largest Courant number per time of the flow as it is [1/s]. Collective.
  [[nodiscard]] double courant_rate() const;

  /// How many numbers save() writes; the same on all ranks.
  [[nodiscard]] std::uint64_t saved_numbers() const;
  /// The solver's whole state, by cells of the grid as it was given: load() continues on any number
  /// of ranks, and bit for bit on the same blocks. `out` and `in` are of rank 0, null elsewhere.
  /// Collective; load() throws ConfigError on all ranks where the state is of another grid or of
  /// other equations.
  void save(RecordWriter* out) const;
  void load(RecordReader* in);

private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

} // namespace granflux::cfd
