// SPDX-FileCopyrightText: 2026 The GranFlux developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <granflux/coupling/ledger.hpp>
#include <granflux/coupling/nusselt/laws.hpp>

#include "charges.hpp"
#include "gas_at_particles.hpp"

namespace granflux::coupling {

/// Heat between gas and particles, where the gas has an energy equation: what the gas step is to
/// take for them, and the books of it. The particles receive it by convected_heat().
class HeatTransfer {
public:
  /// All but `mesh` must outlive this. Throws ConfigError where Nusselt numbers have no
  /// conductivity to count in.
  HeatTransfer(const CouplingOptions& options, const cfd::GasCase& gas_case, const cfd::Mesh& mesh,
               const cfd::GasSolver& gas, GridTransfer& transfer,
               const GasAtParticles& at_particles, Charges& charges);

  /// Throws on all ranks alike where the gas has a temperature and particles have none. Collective.
  void check(const ParticleView& view) const;

  // Both ways, around a gas step.
  /// Conductance between gas and every particle, and what the gas is to be charged for it.
  ExchangeSums charge(const ParticleView& view, double interval);
  /// The same on gas cells, after Charges::deposit(): what `on_gas` is then.
  void hand_to_gas();
  [[nodiscard]] const cfd::HeatExchange& on_gas() const { return on_gas_; }
  /// What the gas step took from the gas for each particle.
  ExchangeSums book(const ParticleView& view, double interval);

  /// One way, after a gas step: of gas that keeps its heat, nothing is booked.
  ExchangeSums act(const ParticleView& view, double interval) const;

private:
  template <class Law>
  Lanes conductance_of(const Law& law, const SeenBlock& seen, ExchangeSums& mine) const;
  Lanes conductance_of(const SeenBlock& seen, ExchangeSums& mine) const;
  static Lanes response(const Lanes& conductance, const ParticleView& view, std::size_t first,
                        std::size_t count, double interval);

  const CouplingOptions& options_;
  const cfd::GasCase& gas_case_;
  const cfd::GasSolver& gas_;
  GridTransfer& transfer_;
  const GasAtParticles& at_particles_;
  Charges& charges_;
  AnyNusseltLaw nusselt_;
  double particles_a_parcel_;
  cfd::HeatExchange on_gas_; ///< empty without an energy equation, and unless both ways
};

} // namespace granflux::coupling
