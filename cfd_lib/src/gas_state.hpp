// SPDX-FileCopyrightText: 2026 The GranFlux developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include <granflux/cfd/boundary.hpp>
#include <granflux/cfd/diffusion_solver.hpp>
#include <granflux/cfd/gas_solver.hpp>
#include <granflux/cfd/gradient.hpp>
#include <granflux/cfd/halo.hpp>
#include <granflux/cfd/pressure_solver.hpp>
#include <granflux/cfd/sweep.hpp>
#include <granflux/cfd/transport_solver.hpp>

#include "convection_sweep.hpp"
#include "energy.hpp"

// Symbols as in docs/theory.md: eps void fraction, F = eps u.S volume flux through a face, a the
// implicit inertia rho eps'/dt + beta, r the right-hand side without the pressure, both per volume.

namespace granflux::cfd {

/// Linear interpolation to the face below position f.
inline double on_face(const Field& q, const Field& weight, std::ptrdiff_t f,
                      std::ptrdiff_t stride) {
  return q[f - stride] + weight[f] * (q[f] - q[f - stride]);
}

/// Whether given pressures (outlets, driving gradient) act, or, for the initial projection, not.
enum class Drive { none, given };

/// What set_pressure_gradient() goes on with.
enum class After { nothing, set_velocity };

/// What the implicit scheme alone needs.
struct ImplicitMomentum {
  TransportSolver solver;
  BlockVectors fixed; ///< right-hand side without the pressure and the new velocity's terms [N/m3]
  BlockVectors convection; ///< at the new time, of each cell [N]
  Vec3 outflow;            ///< of it, through this rank's boundaries [N]
};

/// State of the gas and the parts of its step, each in a file of its own: gas_convection.cpp,
/// gas_friction.cpp, gas_predictor.cpp, gas_implicit.cpp, gas_projection.cpp, gas_balance.cpp.
struct GasSolver::Impl {
  Impl(const Mesh& mesh, const GasCase& gas_case);

  StepReport advance(double dt, const BlockFields& void_fraction, const MomentumExchange* exchange,
                     const HeatExchange* heat);

  // The step, in order.
  void update_velocity_gradient();
  bool move_void_fraction(double dt, const BlockFields& void_fraction);
  void set_conductance();
  void set_medium(double dt, const MomentumExchange* exchange);
  bool set_thermal_buoyancy(const MomentumExchange* exchange);
  Carried carried_momentum(std::size_t m, BlockVectors& out);
  Vec3 convect_momentum(BlockVectors& out);
  [[nodiscard]] double friction_at_boundaries(std::size_t m) const;
  double viscous_force(std::size_t m, BlockFields& out);
  Unknown component(std::size_t m);
  auto spread_by_faces();
  auto spread_in_defect();
  template <class Convected, class Spread>
  void set_momentum(double dt, const BlockVectors* source, Convected&& convected, Spread&& spread);
  void begin_momentum(double dt, const MomentumExchange* exchange);
  void move_boundaries(double new_time);
  void take_defect();
  void predict(double new_time, StepReport& report);
  void add_new_friction(double new_time);
  void close_implicit(double new_time, const MomentumExchange* exchange, StepReport& report);
  void iterate_implicit(double new_time, const MomentumExchange* exchange, StepReport& report);
  void project(double new_time, Drive drive, const MomentumExchange* exchange, StepReport& report);
  void interpolate_momentum(double new_time, Drive drive);
  void take_continuity();
  void set_drag_slope(const MomentumExchange& exchange);
  void set_pressure_gradient(Drive drive, After after);
  void set_velocity(std::size_t b, std::ptrdiff_t row);
  void take_balance(double dt, const MomentumExchange* exchange);

  /// Whether the void fraction has not moved for so long that nothing that follows from it does.
  [[nodiscard]] bool resting() const { return steps_at_rest > 3; }
  [[nodiscard]] Vec3 momentum();
  void measure(double dt, StepReport& report) const;

  // What ends a run: throw NumericalError on all ranks, with step and cell.
  void check_finite() const;
  void check_courant(double dt, double courant) const;
  [[nodiscard]] std::string place(std::size_t b, const Index3& cell) const;

  /// Everything that the next step depends on: numbers, and fields of this rank's blocks.
  [[nodiscard]] std::array<double, 5> state_numbers() const;
  void set_state_numbers(const std::array<double, 5>& numbers);
  [[nodiscard]] std::vector<std::vector<Field*>> state_fields();
  [[nodiscard]] std::vector<double> volumes_given() const;

  const Mesh& mesh;
  Fluid fluid;
  Numerics numerics;
  Halo halo;
  Boundaries boundaries;
  DiffusionSolver diffusion_solver;
  std::unique_ptr<ImplicitMomentum> implicit; ///< only where the case asks for it
  std::unique_ptr<PressureSolver> pressure_solver;

  double time = 0, dt_old = 0;
  long steps = 0;
  bool has_history = false;
  double ab_now = 1, ab_old = 0; ///< Adams-Bashforth weights of this step

  BlockFields eps;         ///< end of the last step
  BlockFields eps_start;   ///< start of the present step, where the momentum equation is centred
  BlockFields eps_middle;  ///< mean over the present step
  BlockFields eps_inertia; ///< carried by the convecting fluxes: what holds the gas's momentum
  BlockFields eps_inertia_start;      ///< the same at the start of the step
  BlockFields eps_rate, eps_rate_old; ///< d eps/dt that the last two fluxes satisfy [1/s]
  long steps_at_rest = 0;             ///< in a row in which the void fraction did not change
  bool exchanged = false;             ///< whether the medium is that of a step with particles
  double eps_rate_noise = 0;          ///< round-off of its mean, at most [1/s]
  BlockVectors u;
  BlockFields p;
  BlockVectors grad_p;                     ///< driving part included
  BlockVectors drag_slope;                 ///< pressure gradient that balances the drag [Pa/m]
  bool has_drag = false;                   ///< drag_slope may be other than 0
  FaceFields flux;                         ///< F [m3/s], along +direction
  BlockVectors convection, convection_old; ///< momentum leaving each cell [N]
  Vec3 outflow, outflow_old;               ///< of it, through the boundaries [N]
  /// Of the step, on this rank's gas: friction in, momentum out through boundaries [N].
  Vec3 boundary_friction, boundary_convection;
  /// Of each component, where the mesh is not orthogonal or eddies are modelled.
  std::array<BlockVectors, 3> velocity_gradient;
  BlockVectors pressure_slope; ///< gradient of p by the same rule, on meshes not orthogonal [Pa/m]
  BlockFields eddy_viscosity;  ///< Pa s; empty where not modelled
  BlockFields a;               ///< kg/(m3 s)
  BlockVectors r;              ///< N/m3
  BlockFields share;           ///< of the pressure gradient that the gas bears
  BlockFields inertia;         ///< a times the cell's volume [kg/s]
  std::array<BlockFields, 3> defect;      ///< of the momentum equation, of each component [N]
  std::array<double, 3> squares_of_terms; ///< of the equation's terms, of each component [N2]
  FaceFields conductance;
  FaceFields face_work;     ///< where the mesh is not orthogonal or eddies are modelled
  std::vector<double> room; ///< for sums over rows
  PressureSystem system;
  Balance balance;
  Vec3 own_momentum;                      ///< of this rank's gas, end of the last step [N s]
  Vec3 thermal_buoyancy;                  ///< of this step, this rank [N]
  std::unique_ptr<EnergyEquation> energy; ///< only where the case asks for it
};

} // namespace granflux::cfd
