// SPDX-FileCopyrightText: 2026 The GranFlux developers
// SPDX-License-Identifier: BSD-3-Clause
#include "momentum_transfer.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include <granflux/cfd/sweep.hpp>
#include <granflux/coupling/fluid_kick.hpp>

#include "particle_sums.hpp"

namespace granflux::coupling {

MomentumTransfer::MomentumTransfer(const TransferParts& parts)
    : parts_(parts), drag_(DragLaws::make("drag", parts.options.drag)) {
  if (!parts_.options.effects.two_way)
    return;
  on_gas_ = cfd::make_exchange(parts_.gas.mesh());
  for (cfd::Field& fraction : on_gas_.pressure_fraction)
    fraction.fill(1); // as it stays where gas and particles exert no force
}

/// Drag coefficients [kg/s], and what is to be known of them.
template <class Law>
Lanes MomentumTransfer::drag_of(const Law& law, const SeenBlock& seen, ExchangeSums& mine) const {
  const double stokes =
      parts_.particles_a_parcel() * 3 * std::numbers::pi * parts_.gas.fluid().viscosity;
  const bool all_pressure_on_gas = parts_.options.model == MomentumModel::b;
  const auto in = [&](std::size_t i) {
    return DragInput{.reynolds = seen.reynolds[i], .void_fraction = seen.void_fraction[i]};
  };
  mine.law_out_of_range +=
      count_outside(seen, [&](std::size_t i) { return law.valid.contains(in(i)); });
  mine.slip_reynolds_max = std::max(mine.slip_reynolds_max, largest(seen.reynolds));
  return lanes([&](std::size_t i) {
    const double per_eps = stokes * seen.diameter[i] * law(in(i));
    return all_pressure_on_gas ? per_eps : per_eps * seen.void_fraction[i];
  });
}

ExchangeSums MomentumTransfer::charge(const ParticleView& view, double interval) {
  return with_drag([&](const auto& law) { return charge(law, view, interval); });
}

template <class Law>
ExchangeSums MomentumTransfer::charge(const Law& law, const ParticleView& view, double interval) {
  const bool at_once = parts_.options.drag_treatment != DragTreatment::implicit_in_both;
  const auto of_block = [&](std::size_t first, std::size_t count, ExchangeSums& mine) {
    Lanes b{}, effective{};
    if constexpr (!std::is_same_v<Law, NoDrag>) {
      b = drag_of(law, parts_.at_particles.see_before(view, first, count), mine);
      Lanes lambda{};
      for (std::size_t i = 0; i < count; ++i)
        if (view.fixed.empty() || !view.fixed[first + i])
          lambda[i] = b[i] * interval / view.mass[first + i];
      mine.stiffness_max = std::max(mine.stiffness_max, largest(lambda));
      effective = at_once ? b : effective_coefficients(b, lambda);
    }
    VectorLanes handed_over;
    for (std::size_t i = 0; i < particles_a_block; ++i) {
      const std::size_t p = first + i;
      if (i >= count || !parts_.transfer.placed(p)) {
        handed_over.set(i, {});
        if (i < count) {
          view.fluid[p] = {};
          if (parts_.charges.forces())
            std::fill_n(parts_.charges.momentum(p), 4, 0);
        }
        continue;
      }
      FluidState& state = view.fluid[p];
      state.void_fraction = parts_.at_particles.void_fraction(p);
      if constexpr (!std::is_same_v<Law, NoDrag>)
        state.drag_coefficient = b[i];
      const Vec3 still = explicit_drag() ? parts_.at_particles.velocity_before(p) : Vec3{};
      const Vec3 source = effective[i] * (view.velocity[p] - still) - state.hand_over / interval;
      if (parts_.charges.forces())
        std::ranges::copy(std::array{effective[i], source.x, source.y, source.z},
                          parts_.charges.momentum(p));
      handed_over.set(i, state.hand_over);
    }
    mine.handed_over += handed_over.sum();
    mine.exchanged += handed_over.sum_of_norms();
  };
  return sum_blocks<ExchangeSums>(view.size(), of_block);
}

void MomentumTransfer::hand_to_gas(const cfd::BlockFields& void_fraction, double interval,
                                   ExchangeSums& sums) {
  const auto& work = parts_.transfer.work;
  const bool gas_bears_all =
      parts_.options.model == MomentumModel::b || !parts_.options.effects.pressure_gradient;
  const cfd::Mesh& mesh = parts_.gas.mesh();
  for (std::size_t b = 0; b < mesh.local.size(); ++b)
    cfd::for_cells(mesh.local[b].layout, [&](std::ptrdiff_t c) {
      on_gas_.drag_coefficient[b][c] = work[0][b][c];
      for (std::size_t d = 0; d < 3; ++d)
        on_gas_.drag_source[b][d][c] = work[1 + d][b][c];
      on_gas_.pressure_fraction[b][c] = gas_bears_all ? 1 : void_fraction[b][c];
    });
  if (explicit_drag())
    take_drag_at_start(void_fraction, interval, sums);
}

/// The source is the drag of the slip before the gas step: nothing is left to go with the new
/// velocity, neither here nor in the pressure equation.
void MomentumTransfer::take_drag_at_start(const cfd::BlockFields& void_fraction, double interval,
                                          ExchangeSums& sums) {
  const cfd::Mesh& mesh = parts_.gas.mesh();
  for (std::size_t b = 0; b < mesh.local.size(); ++b) {
    const double largest = cfd::max_cells(mesh.local[b].layout, 0, [&](std::ptrdiff_t c) {
      return on_gas_.drag_coefficient[b][c] / void_fraction[b][c];
    });
    sums.gas_drag_number_max =
        std::max(sums.gas_drag_number_max, interval * largest / parts_.gas.fluid().density);
    on_gas_.drag_coefficient[b].fill(0);
  }
}

ExchangeSums MomentumTransfer::book(const ParticleView& view, double interval) {
  const auto of_block = [&](std::size_t first, std::size_t count, ExchangeSums& mine) {
    GasAtParticles::Push seen = parts_.at_particles.push(view, first, count);
    VectorLanes drag_force;
    Lanes effective;
    for (std::size_t i = 0; i < particles_a_block; ++i) {
      const std::size_t p = first + i;
      effective[i] = 0;
      drag_force.set(i, {});
      if (i >= count || !parts_.transfer.placed(p))
        continue;
      effective[i] = parts_.charges.momentum(p)[0];
      drag_force.set(i, view.velocity[p]);
      if (explicit_drag())
        seen.velocity.set(i, parts_.at_particles.velocity_before(p));
    }
    VectorLanes booked;
    for (int d = 0; d < 3; ++d) {
      Lanes& force = drag_force[d]; // so far the particles' velocity
      force = lanes([&](std::size_t i) { return effective[i] * (seen.velocity[d][i] - force[i]); });
      booked[d] =
          lanes([&](std::size_t i) { return interval * (force[i] + seen.pressure_force[d][i]); });
    }
    for (std::size_t i = 0; i < count; ++i) {
      if (!parts_.transfer.placed(first + i))
        continue;
      FluidState& state = view.fluid[first + i];
      state.gas_velocity = seen.velocity.at(i);
      state.pressure_force = seen.pressure_force.at(i);
      state.hand_over = -booked.at(i);
    }
    mine.drag += drag_force.sum();
    mine.pressure_force += seen.pressure_force.sum();
    mine.booked += booked.sum();
    mine.exchanged += booked.sum_of_norms();
  };
  return sum_blocks<ExchangeSums>(view.size(), of_block);
}

void MomentumTransfer::free_gas() {
  for (std::size_t b = 0; b < on_gas_.pressure_fraction.size(); ++b) {
    on_gas_.pressure_fraction[b].fill(1);
    on_gas_.drag_coefficient[b].fill(0);
    for (cfd::Field& component : on_gas_.drag_source[b])
      component.fill(0);
  }
}

ExchangeSums MomentumTransfer::act(const ParticleView& view, double interval) {
  return with_drag([&](const auto& law) { return act(law, view, interval); });
}

template <class Law>
ExchangeSums MomentumTransfer::act(const Law& law, const ParticleView& view,
                                   double interval) const {
  const auto of_block = [&](std::size_t first, std::size_t count, ExchangeSums& mine) {
    const GasAtParticles::Push seen = parts_.at_particles.push(view, first, count);
    Lanes b;
    if constexpr (!std::is_same_v<Law, NoDrag>)
      b = drag_of(law, parts_.at_particles.see_alone(view, first, count), mine);
    for (std::size_t i = 0; i < count; ++i) {
      const std::size_t p = first + i;
      FluidState& state = view.fluid[p];
      if (!parts_.transfer.placed(p)) {
        state = {};
        continue;
      }
      state.void_fraction = 1;
      state.gas_velocity = seen.velocity.at(i);
      state.pressure_force = seen.pressure_force.at(i);
      if constexpr (!std::is_same_v<Law, NoDrag>) {
        state.drag_coefficient = b[i];
        mine.drag += b[i] * (state.gas_velocity - view.velocity[p]);
        if (view.fixed.empty() || !view.fixed[p])
          mine.stiffness_max = std::max(mine.stiffness_max, b[i] * interval / view.mass[p]);
      }
      mine.pressure_force += state.pressure_force;
      mine.particle_volume += sphere_volume(view.radius[p]);
    }
  };
  return sum_blocks<ExchangeSums>(view.size(), of_block);
}

auto MomentumTransfer::response(bool some_fixed) const
    -> std::variant<ResponseIs<Response::exact>, ResponseIs<Response::exact_unless_fixed>,
                    ResponseIs<Response::at_once>> {
  if (parts_.options.drag_treatment != DragTreatment::implicit_in_both)
    return ResponseIs<Response::at_once>();
  if (some_fixed)
    return ResponseIs<Response::exact_unless_fixed>();
  return ResponseIs<Response::exact>();
}

/// Of a unit of volume.
Vec3 MomentumTransfer::weight_of_gas() const {
  return parts_.options.effects.pressure_gradient
             ? -parts_.gas.fluid().density * parts_.gas.fluid().gravity
             : Vec3{};
}

Vec3 MomentumTransfer::apply(const ParticleView& view, double dt, double share) const {
  const auto choice = [](bool condition) {
    return condition ? std::variant<std::false_type, std::true_type>(std::true_type{})
                     : std::false_type{};
  };
  const ExchangeEffects& effects = parts_.options.effects;
  return std::visit(
      [&](auto how, auto drag, auto pressure, auto two_way) {
        return apply<how, drag, pressure, two_way>(view, dt, share);
      },
      response(!view.fixed.empty()), choice(effects.drag), choice(effects.pressure_gradient),
      choice(effects.two_way));
}

template <MomentumTransfer::Response how, bool drag, bool pressure, bool two_way>
Vec3 MomentumTransfer::apply(const ParticleView& view, double dt, double share) const {
  const Vec3 weight = weight_of_gas();
  return sum_particles<Vec3>(view.size(), [&](std::size_t p, Vec3& mine) {
    FluidState& state = view.fluid[p];
    if (!(state.void_fraction > 0)) { // not coupled yet, outside the grid or not in the group
      state.force = {};
      return;
    }
    Vec3 exchanged, buoyancy;
    if constexpr (pressure) {
      buoyancy = sphere_volume(view.radius[p]) * weight;
      exchanged = state.pressure_force;
    }
    if constexpr (drag && how == Response::at_once) {
      const Vec3 drag_force = state.drag_coefficient * (state.gas_velocity - view.velocity[p]);
      exchanged = pressure ? drag_force + state.pressure_force : drag_force;
    } else if constexpr (drag) {
      Vec3 other = view.force[p];
      if constexpr (pressure)
        other = view.force[p] + state.pressure_force + buoyancy;
      double lambda = state.drag_coefficient * dt / view.mass[p];
      if constexpr (how == Response::exact_unless_fixed)
        lambda = view.fixed[p] ? 0 : lambda;
      const Vec3 drag_force =
          exact_drag(state.drag_coefficient, lambda, state.gas_velocity, view.velocity[p], other);
      exchanged = pressure ? drag_force + state.pressure_force : drag_force;
    }
    state.force = pressure ? exchanged + buoyancy : exchanged;
    view.force[p] += state.force;
    if constexpr (two_way) {
      const Vec3 impulse = share * dt * exchanged;
      state.hand_over += impulse;
      mine += impulse;
    }
  });
}

Vec3 MomentumTransfer::unapply(const ParticleView& view, double dt, double share) const {
  const Vec3 weight = weight_of_gas();
  return sum_particles<Vec3>(view.size(), [&](std::size_t p, Vec3& mine) {
    FluidState& state = view.fluid[p];
    if (!(state.void_fraction > 0))
      return;
    const Vec3 exchanged = state.force - sphere_volume(view.radius[p]) * weight;
    const Vec3 impulse = -share * dt * exchanged;
    state.hand_over += impulse;
    mine += impulse;
  });
}

} // namespace granflux::coupling
