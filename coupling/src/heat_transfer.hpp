// SPDX-FileCopyrightText: 2026 The GranFlux developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include <granflux/coupling/ledger.hpp>
#include <granflux/coupling/nusselt/laws.hpp>

#include "transfer_parts.hpp"

namespace granflux::coupling {

/// Heat between gas and particles, where the gas has an energy equation: what the gas step is to
/// take for them, and the books of it. The particles receive it by convected_heat().
class HeatTransfer {
public:
  /// The case must outlive this. Throws ConfigError where Nusselt numbers have no conductivity to
  /// count in.
  HeatTransfer(const TransferParts& parts, const cfd::GasCase& gas_case);

  /// Where the gas has a temperature and particles have none; else empty.
  [[nodiscard]] std::string complaint_about(const ParticleView& view) const;

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

  const TransferParts parts_;
  const cfd::GasCase& gas_case_;
  AnyNusseltLaw nusselt_;
  cfd::HeatExchange on_gas_; ///< empty without an energy equation, and unless both ways
};

} // namespace granflux::coupling
