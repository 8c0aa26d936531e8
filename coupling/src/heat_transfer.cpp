// SPDX-FileCopyrightText: 2026 The GranFlux developers
// SPDX-License-Identifier: BSD-3-Clause
#include "heat_transfer.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <variant>

#include <granflux/cfd/error.hpp>
#include <granflux/cfd/sweep.hpp>

#include "particle_sums.hpp"

namespace granflux::coupling {

HeatTransfer::HeatTransfer(const TransferParts& parts, const cfd::GasCase& gas_case)
    : parts_(parts), gas_case_(gas_case),
      nusselt_(NusseltLaws::make("nusselt", parts.options.nusselt)) {
  if (!parts_.charges.heat())
    return;
  if (gas_case.energy->conductivity == 0 && parts_.options.heat_transfer_coefficient == 0)
    throw ConfigError("[energy] conductivity: must be above 0, for Nusselt numbers count in it; "
                      "[coupling] heat_transfer_coefficient does without");
  if (parts_.options.effects.two_way)
    on_gas_ = {.coefficient = cfd::make_fields(parts_.gas.mesh()),
               .source = cfd::make_fields(parts_.gas.mesh())};
}

std::string HeatTransfer::complaint_about(const ParticleView& view) const {
  const bool without = parts_.charges.heat() && view.heat.size() != view.size();
  return without ? "[energy]: the particles have no temperature that the gas could change" : "";
}

/// Between the gas and particles [W/K].
Lanes HeatTransfer::conductance_of(const SeenBlock& seen, ExchangeSums& mine) const {
  const double given = parts_.options.heat_transfer_coefficient;
  if (given > 0) {
    const double pi = parts_.particles_a_parcel() * std::numbers::pi;
    return lanes([&](std::size_t i) { return pi * seen.diameter[i] * seen.diameter[i] * given; });
  }
  return std::visit([&](const auto& law) { return conductance_of(law, seen, mine); }, nusselt_);
}

template <class Law>
Lanes HeatTransfer::conductance_of(const Law& law, const SeenBlock& seen,
                                   ExchangeSums& mine) const {
  const double k = gas_case_.energy->conductivity;
  const double prandtl = parts_.gas.fluid().viscosity * gas_case_.energy->heat_capacity / k;
  const double pi_k = parts_.particles_a_parcel() * std::numbers::pi * k;
  const auto in = [&](std::size_t i) {
    return NusseltInput{
        .reynolds = seen.reynolds[i], .prandtl = prandtl, .void_fraction = seen.void_fraction[i]};
  };
  mine.nusselt_out_of_range +=
      count_outside(seen, [&](std::size_t i) { return law.valid.contains(in(i)); });
  return lanes([&](std::size_t i) { return pi_k * seen.diameter[i] * law(in(i)); });
}

/// h A T/(m c) of a block of particles; 0 where the temperature is fixed.
Lanes HeatTransfer::response(const Lanes& conductance, const ParticleView& view, std::size_t first,
                             std::size_t count, double interval) {
  Lanes lambda{};
  for (std::size_t i = 0; i < count; ++i)
    if (view.fixed_temperature.empty() || !view.fixed_temperature[first + i])
      lambda[i] = conductance[i] * interval / view.heat_capacity[first + i];
  return lambda;
}

ExchangeSums HeatTransfer::charge(const ParticleView& view, double interval) {
  const auto of_block = [&](std::size_t first, std::size_t count, ExchangeSums& mine) {
    const Lanes conductance =
        conductance_of(parts_.at_particles.see_before(view, first, count), mine);
    const Lanes lambda = response(conductance, view, first, count, interval);
    mine.heat_stiffness_max = std::max(mine.heat_stiffness_max, largest(lambda));
    const Lanes effective = effective_coefficients(conductance, lambda);
    Lanes handed_over{};
    for (std::size_t i = 0; i < count; ++i) {
      const std::size_t p = first + i;
      HeatState& state = view.heat[p];
      if (!parts_.transfer.placed(p)) {
        state = {};
        std::fill_n(parts_.charges.heat(p), 2, 0);
        continue;
      }
      state.conductance = conductance[i];
      handed_over[i] = state.received - state.booked;
      double* const terms = parts_.charges.heat(p);
      terms[0] = effective[i];
      terms[1] = effective[i] * view.temperature[p] - handed_over[i] / interval;
    }
    mine.heat_handed_over += sum(handed_over);
    mine.heat_exchanged += sum(lanes([&](std::size_t i) { return std::abs(handed_over[i]); }));
  };
  return sum_blocks<ExchangeSums>(view.size(), of_block);
}

void HeatTransfer::hand_to_gas() {
  const cfd::Mesh& mesh = parts_.gas.mesh();
  const std::size_t first = parts_.charges.first_of_heat();
  for (std::size_t b = 0; b < mesh.local.size(); ++b)
    cfd::for_cells(mesh.local[b].layout, [&](std::ptrdiff_t c) {
      on_gas_.coefficient[b][c] = parts_.transfer.work[first][b][c];
      on_gas_.source[b][c] = parts_.transfer.work[first + 1][b][c];
    });
}

ExchangeSums HeatTransfer::book(const ParticleView& view, double interval) {
  const auto of_block = [&](std::size_t first, std::size_t count, ExchangeSums& mine) {
    Lanes booked{};
    for (std::size_t i = 0; i < count; ++i) {
      const std::size_t p = first + i;
      if (!parts_.transfer.placed(p))
        continue;
      HeatState& state = view.heat[p];
      state.gas_temperature = parts_.at_particles.temperature(p);
      state.booked =
          interval * parts_.charges.heat(p)[0] * (state.gas_temperature - view.temperature[p]);
      state.received = 0;
      booked[i] = state.booked;
    }
    mine.heat_booked += sum(booked);
    mine.heat_exchanged += sum(lanes([&](std::size_t i) { return std::abs(booked[i]); }));
  };
  return sum_blocks<ExchangeSums>(view.size(), of_block);
}

ExchangeSums HeatTransfer::act(const ParticleView& view, double interval) const {
  const auto of_block = [&](std::size_t first, std::size_t count, ExchangeSums& mine) {
    const Lanes conductance =
        conductance_of(parts_.at_particles.see_alone(view, first, count), mine);
    mine.heat_stiffness_max = std::max(
        mine.heat_stiffness_max, largest(response(conductance, view, first, count, interval)));
    for (std::size_t p = first; p < first + count; ++p) {
      HeatState& state = view.heat[p];
      if (!parts_.transfer.placed(p)) {
        state = {};
        continue;
      }
      state.conductance = conductance[p - first];
      state.gas_temperature = parts_.at_particles.temperature(p);
    }
  };
  return sum_blocks<ExchangeSums>(view.size(), of_block);
}

} // namespace granflux::coupling
