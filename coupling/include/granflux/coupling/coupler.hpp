// SPDX-FileCopyrightText: 2026 The GranFlux developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include <granflux/cfd/gas_solver.hpp>
#include <granflux/coupling/grid_extent.hpp>
#include <granflux/coupling/particle_view.hpp>

namespace granflux::coupling {

/// Which phase bears the pressure gradient (docs/theory.md): a: both, by volume; b: the gas alone,
/// the particles' share folded into the drag (beta_B = beta_A / eps).
enum class MomentumModel { a, b };

/// Which phase takes the drag at its own new velocity (docs/theory_coupling.md, section 8).
enum class DragTreatment {
  /// None: both take it at the slip of the coupling step. Stable within limits of the steps.
  explicit_in_both,
  /// The gas; particles take it at their velocity before each step, which has a limit.
  implicit_in_gas,
  /// Both, the particles exactly: any step is stable.
  implicit_in_both
};

/// What gas and particles do to each other; what is off is not computed.
struct ExchangeEffects {
  /// Particles displace the gas and take momentum and heat out of it. Off: it flows as if there
  /// were none, and its books of the exchange stay at zero.
  bool two_way = true;
  bool drag = true;
  /// Pressure gradient and buoyancy act on particles.
  bool pressure_gradient = true;

  [[nodiscard]] bool any_force() const { return drag || pressure_gradient; }
};

/// The [coupling] table of the case file.
struct CouplingOptions {
  std::string drag = "gidaspow";           ///< a name of DragLaws
  std::string void_fraction = "trilinear"; ///< a name of the void-fraction kernels
  std::string nusselt = "gunn";            ///< a name of NusseltLaws
  double heat_transfer_coefficient = 0;    ///< W/(m2 K); above 0 it takes the law's place
  double smoothing_width = 3;              ///< of the smoothed kernel, in particle diameters
  MomentumModel model = MomentumModel::a;
  DragTreatment drag_treatment = DragTreatment::implicit_in_both;
  /// Diameter of a parcel over that of the particles it stands for, 1 or more: the particles of the
  /// host are parcels of coarse_graining^3 particles each, which take drag and heat singly.
  double coarse_graining = 1;
  /// A cell below this void fraction stops the run; nothing is clamped.
  double void_fraction_floor = 0.05;
  ExchangeEffects effects;
};

/// Sums over all ranks at one coupling step; equal on every rank.
struct ExchangeReport {
  cfd::StepReport gas;
  long particles = 0;         ///< coupled, inside the grid
  long outside = 0;           ///< in the fix group but outside the gas grid: not coupled
  double particle_volume = 0; ///< sum V_p of the coupled particles [m3]
  double volume_residual = 0; ///< |sum (1-eps) V - sum V_p| / sum V_p
  double void_fraction_min = 1;
  /// Mean drag on all particles as the gas was charged for it over the interval, what the last
  /// interval was charged too little or too much included [N].
  Vec3 drag;
  Vec3 pressure_force; ///< sum of -V grad p over the particles [N]
  /// Momentum ledger since the start, buoyancy left out [N s]:
  ///   impulse_from_gas = impulse_to_particles + in_transit + carried_out + remainder.
  /// The first is by the gas's own balance; in_transit was charged to the gas and is still to be
  /// applied to the particles; carried_out went with particles that left in between.
  Vec3 impulse_from_gas, impulse_to_particles, in_transit, carried_out;
  double momentum_residual = 0; ///< |remainder| / sum of |impulses| exchanged
  /// |rate of the gas's momentum - forces through its boundaries - driving force + impulse that the
  /// particles were booked / interval| over the gas's Balance::momentum_scale: one budget of both.
  double budget_residual = 0;
  double slip_reynolds_max = 0;
  /// Largest b T/m of a particle that is not fixed: coupling interval over response time. Above
  /// 1.5 gas in a packed bed is not stable (docs/theory_coupling.md, section 7).
  double stiffness_max = 0;
  /// Largest T beta/(eps rho) of a cell, beta the drag coefficient in it: what the gas step is of
  /// the time in which drag alone would stop the gas. Only where it is explicit in the gas, else 0.
  double gas_drag_number_max = 0;
  long law_out_of_range = 0; ///< particles outside the drag law's range of validity
  // Heat, where the gas has an energy equation.
  /// Heat that the particles took from the gas, mean over the interval, what the last interval was
  /// charged too little or too much included [W].
  double heat_rate = 0;
  /// Heat ledger since the start [J]: from_gas = to_particles + in_transit + carried_out +
  /// remainder.
  double heat_from_gas = 0, heat_to_particles = 0, heat_in_transit = 0, heat_carried_out = 0;
  double heat_residual = 0; ///< |remainder| / sum of |heats| exchanged
  /// Largest h A T/(m c) of a particle: coupling interval over the time its temperature takes.
  double heat_stiffness_max = 0;
  long nusselt_out_of_range = 0; ///< particles outside the Nusselt law's range of validity
};

/// Seconds spent, this rank.
struct CouplingTimes {
  double gas = 0, locate = 0, deposit = 0, sample = 0, messages = 0, force = 0;
  double laws = 0; ///< drag and Nusselt numbers of the particles, and their books
};

/// Two-way coupling of particles that a host moves with the gas of cfd_lib. One coupling step:
/// locate, weigh, deposit void fraction and drag, advance the gas, sample it at the particles.
class Coupler {
public:
  Coupler(const cfd::GasCase& gas_case, const CouplingOptions& options, MPI_Comm comm);
  ~Coupler();
  Coupler(const Coupler&) = delete;
  Coupler& operator=(const Coupler&) = delete;

  /// Before the first step: void fraction of the particles where they are, gas at its initial
  /// state. Throws ConfigError where a coupled particle lies outside the gas grid. Collective.
  void initialise(const ParticleView& particles, double time);

  /// Coupling step: advances the gas over `interval` seconds and renews every FluidState (drag
  /// coefficient, gas velocity, pressure force, booked impulse). Particles outside the gas grid
  /// are left alone and counted. Collective; throws NumericalError on every rank alike.
  const ExchangeReport& exchange(const ParticleView& particles, double interval);

  /// Every particle step, with all other forces in view.force: adds the fluid force, exact for
  /// constant gas velocity and other forces over `dt`, however stiff the drag, and buoyancy.
  /// `share` of the impulse force * dt is booked as received (1; 1/2 for a kick that the
  /// integrator halves).
  void apply(const ParticleView& particles, double dt, double share = 1);
  /// Heat that particles of this rank received by convected_heat() since the last call [J].
  void received_heat(double heat);

  /// Takes back the part of the last force's impulse that the integrator never applied.
  void unapply(const ParticleView& particles, double dt, double share);

  [[nodiscard]] const ExchangeReport& report() const;
  [[nodiscard]] const CouplingTimes& times() const;
  /// Numbers that this rank has sent to gas and particles of other ranks so far.
  [[nodiscard]] long numbers_sent() const;
  [[nodiscard]] cfd::GasSolver& gas();
  [[nodiscard]] const cfd::Mesh& mesh() const;
  /// Of the gas grid.
  [[nodiscard]] const GridExtent& extent() const;

  /// Solver state and books, as GasSolver::save; the host keeps the FluidStates. load() takes the
  /// place of initialise().
  [[nodiscard]] std::uint64_t saved_numbers() const;
  void save(cfd::RecordWriter* out) const;
  void load(cfd::RecordReader* in);

private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

} // namespace granflux::coupling
