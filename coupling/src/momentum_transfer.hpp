// SPDX-FileCopyrightText: 2026 The GranFlux developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <type_traits>
#include <variant>

#include <granflux/coupling/drag/laws.hpp>
#include <granflux/coupling/ledger.hpp>

#include "transfer_parts.hpp"

namespace granflux::coupling {

/// Drag and pressure gradient between gas and particles: what the gas step is to take for them, the
/// books of it, and the force in every particle step. T is the coupling interval [s].
class MomentumTransfer {
public:
  explicit MomentumTransfer(const TransferParts& parts);

  // Both ways, around a gas step.
  /// Drag coefficient of every particle, and what the gas is to be charged for it.
  ExchangeSums charge(const ParticleView& view, double interval);
  /// The same on gas cells, after Charges::deposit(): what `on_gas` is then.
  void hand_to_gas(const cfd::BlockFields& void_fraction, double interval, ExchangeSums& sums);
  /// What the gas step took from the gas for each particle.
  ExchangeSums book(const ParticleView& view, double interval);
  /// As where no particle is left.
  void free_gas();
  [[nodiscard]] const cfd::MomentumExchange& on_gas() const { return on_gas_; }

  /// One way, after a gas step: of gas that flows as if there were no particles, void fraction 1,
  /// nothing booked.
  ExchangeSums act(const ParticleView& view, double interval);

  /// The fluid force of a particle step; what the particles were given by the gas [N s].
  Vec3 apply(const ParticleView& view, double dt, double share) const;
  Vec3 unapply(const ParticleView& view, double dt, double share) const;

private:
  /// Where there is no drag.
  struct NoDrag {};
  /// How particles respond to drag within a step: exactly; the same but for those held in place; or
  /// with their velocity before the step.
  enum class Response { exact, exact_unless_fixed, at_once };
  template <Response r> using ResponseIs = std::integral_constant<Response, r>;

  /// Calls use(law) with the law of drag, or NoDrag where there is none.
  template <class Use> auto with_drag(Use&& use) const {
    return parts_.options.effects.drag ? std::visit(use, drag_) : use(NoDrag{});
  }
  [[nodiscard]] bool explicit_drag() const {
    return parts_.options.drag_treatment == DragTreatment::explicit_in_both;
  }
  template <class Law>
  Lanes drag_of(const Law& law, const SeenBlock& seen, ExchangeSums& mine) const;
  template <class Law>
  ExchangeSums charge(const Law& law, const ParticleView& view, double interval);
  template <class Law>
  ExchangeSums act(const Law& law, const ParticleView& view, double interval) const;
  void take_drag_at_start(const cfd::BlockFields& void_fraction, double interval,
                          ExchangeSums& sums);
  [[nodiscard]] std::variant<ResponseIs<Response::exact>, ResponseIs<Response::exact_unless_fixed>,
                             ResponseIs<Response::at_once>>
  response(bool some_fixed) const;
  template <Response how, bool drag, bool pressure, bool two_way>
  Vec3 apply(const ParticleView& view, double dt, double share) const;
  [[nodiscard]] Vec3 weight_of_gas() const;

  const TransferParts parts_;
  AnyDragLaw drag_;
  cfd::MomentumExchange on_gas_; ///< empty unless both ways
};

} // namespace granflux::coupling
