// SPDX-FileCopyrightText: 2026 The GranFlux developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <memory>

#include <granflux/cfd/boundary.hpp>
#include <granflux/cfd/diffusion_solver.hpp>
#include <granflux/cfd/gas_solver.hpp>
#include <granflux/cfd/halo.hpp>
#include <granflux/cfd/transport_solver.hpp>

#include "convection_sweep.hpp"

namespace granflux::cfd {

/// rho cp [ d(eps T)/dt + div(eps u T) ] = div(eps k grad T) + Q on the fluxes of a gas step, which
/// satisfy continuity with the same void fractions: a uniform temperature stays uniform. T lives,
/// like eps, at the ends of steps; convection takes it extrapolated to the middle, where the
/// fluxes are; Crank-Nicolson for conduction, more implicit where that would leave the bounds of
/// the temperature; the second phase's coefficient implicit.
class EnergyEquation {
public:
  EnergyEquation(const Mesh& mesh, const Halo& halo, const Boundaries& boundaries,
                 const Fluid& fluid, const Energy& energy, const Numerics& numerics);

  void initialise();
  void set_temperature(const BlockFields& temperature);
  [[nodiscard]] const BlockFields& temperature() const { return temperature_; }
  [[nodiscard]] const Energy& properties() const { return energy_; }

  /// Void fraction of the step's start; call before it changes.
  void begin(const BlockFields& eps) { eps_ = eps; }
  /// `ratio`: this time step over the last one, 0 in a first step. Fills the energy terms of
  /// `balance`. Collective.
  /// `eddy_viscosity` [Pa s] is empty where it is not modelled; eddies conduct with a turbulent
  /// Prandtl number of 0.85.
  void advance(double dt, double ratio, const FaceFields& flux, const BlockFields& eps,
               const BlockFields& eps_middle, const BlockFields& eddy_viscosity,
               const HeatExchange* exchange, FaceFields& work, Balance& balance);

  /// What the next step depends on.
  [[nodiscard]] std::array<BlockFields*, 2> state() { return {&temperature_, &temperature_old_}; }

private:
  /// What crossed this rank's boundaries in a step [W].
  struct Crossed {
    double conducted = 0; ///< into the gas
    double carried = 0;   ///< out of it, with the new temperature
  };

  void fill_ghosts(BlockFields& temperature, const FaceConductance& conductance) const;
  void set_conductance(const BlockFields& eps_middle, const BlockFields& eddy_viscosity);
  double conduct(const FaceConductance& conductance, BlockFields& spread, FaceFields& work);
  double convect_heat(const FaceFields& flux, const BlockFields& carried, FaceFields& work);
  void solve(const FaceFields& flux, FaceFields& work);
  double count_conduction(double dt, BlockFields& number) const;
  bool out_of_bounds();
  void part_conductance(BlockFields& number);
  Crossed step(const FaceFields& flux, FaceFields& work);
  Crossed bounded_step(double dt, const FaceFields& flux, FaceFields& work);
  template <class Term> [[nodiscard]] double sum(Term&& term) const;

  const Mesh& mesh_;
  const Halo& halo_;
  const Boundaries& boundaries_;
  Energy energy_;
  Numerics numerics_;
  double capacity_; ///< rho cp [J/(m3 K)]
  DiffusionSolver solver_;
  std::unique_ptr<TransportSolver> implicit_;          ///< only where the scheme is implicit
  BlockFields temperature_, temperature_old_, middle_; ///< K
  BlockFields eps_, inertia_, rhs_, defect_, flow_, spread_, spread_before_;
  BlockVectors gradient_;       ///< only where the mesh is not orthogonal [K/m]
  FaceConductance conductance_; ///< k eps_f |S|^2/(S.dx) [W/K]
  /// That of the old temperature where it differs from the new one's; else empty.
  FaceConductance conductance_before_;
};

} // namespace granflux::cfd
