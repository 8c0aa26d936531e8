// SPDX-FileCopyrightText: 2026 The GranFlux developers
// SPDX-License-Identifier: BSD-3-Clause
#include "gas_at_particles.hpp"

#include <cmath>
#include <utility>

#include <granflux/coupling/fluid_kick.hpp>

namespace granflux::coupling {

Lanes effective_coefficients(const Lanes& b, const Lanes& lambda) {
  Lanes effective = lanes([&](std::size_t i) { return b[i] * (1 + small_lag(lambda[i])); });
  if (!(largest(lambda) < small_lag_limit))
    for (std::size_t i = 0; i < particles_a_block; ++i)
      effective[i] = effective_coefficient(b[i], lambda[i]);
  return effective;
}

GasAtParticles::GasAtParticles(const CouplingOptions& options, const cfd::GasSolver& gas,
                               GridTransfer& transfer)
    : options_(options), gas_(gas), transfer_(transfer),
      diameter_over_radius_(2 / options.coarse_graining) {}

void GasAtParticles::sample_before(const cfd::BlockFields& void_fraction) {
  fields_.clear();
  for (std::size_t b = 0; b < void_fraction.size(); ++b) {
    fields_.push_back(&void_fraction[b]);
    for (const cfd::Field& component : gas_.velocity()[b])
      fields_.push_back(&component);
  }
  before_.resize(4 * transfer_.weights().particles());
  transfer_.sample<4>(fields_, before_);
}

void GasAtParticles::sample_after() {
  const bool with_pressure = options_.effects.pressure_gradient;
  const cfd::BlockFields* const temperature = gas_.temperature();
  fields_.clear();
  for (std::size_t b = 0; b < gas_.velocity().size(); ++b) {
    for (const cfd::Field& component : gas_.velocity()[b])
      fields_.push_back(&component);
    if (with_pressure)
      for (const cfd::Field& component : gas_.pressure_gradient()[b])
        fields_.push_back(&component);
    if (temperature)
      fields_.push_back(&(*temperature)[b]);
  }
  after_.resize(after_numbers() * transfer_.weights().particles());
  if (with_pressure && temperature)
    transfer_.sample<7>(fields_, after_);
  else if (with_pressure)
    transfer_.sample<6>(fields_, after_);
  else if (temperature)
    transfer_.sample<4>(fields_, after_);
  else
    transfer_.sample<3>(fields_, after_);
}

/// gas_at(p): the void fraction at a particle, and the gas velocity [m/s].
template <class Gas>
SeenBlock GasAtParticles::see(const ParticleView& view, std::size_t first, std::size_t count,
                              Gas&& gas_at) const {
  SeenBlock seen;
  Lanes slip_squared;
  for (std::size_t i = 0; i < particles_a_block; ++i) {
    const std::size_t p = first + i;
    const bool there = i < count && transfer_.placed(p);
    seen.there[i] = there;
    seen.void_fraction[i] = 1;
    seen.diameter[i] = slip_squared[i] = 0;
    if (!there)
      continue;
    const auto& [eps, velocity] = gas_at(p);
    const Vec3 slip = velocity - view.velocity[p];
    seen.void_fraction[i] = eps;
    seen.diameter[i] = diameter_over_radius_ * view.radius[p];
    slip_squared[i] = dot(slip, slip);
  }
  const double rho = gas_.fluid().density, mu = gas_.fluid().viscosity;
  seen.reynolds = lanes([&](std::size_t i) {
    return rho * seen.void_fraction[i] * std::sqrt(slip_squared[i]) * seen.diameter[i] / mu;
  });
  return seen;
}

SeenBlock GasAtParticles::see_before(const ParticleView& view, std::size_t first,
                                     std::size_t count) const {
  return see(view, first, count,
             [&](std::size_t p) { return std::pair(void_fraction(p), velocity_before(p)); });
}

SeenBlock GasAtParticles::see_alone(const ParticleView& view, std::size_t first,
                                    std::size_t count) const {
  return see(view, first, count, [&](std::size_t p) {
    const double* const u = after(p);
    return std::pair(1., Vec3{u[0], u[1], u[2]});
  });
}

GasAtParticles::Push GasAtParticles::push(const ParticleView& view, std::size_t first,
                                          std::size_t count) const {
  Push seen;
  Lanes bearing; // of the pressure gradient [m3]
  const bool bears = options_.effects.pressure_gradient && options_.model == MomentumModel::a;
  for (std::size_t i = 0; i < particles_a_block; ++i) {
    const std::size_t p = first + i;
    seen.velocity.set(i, {});
    seen.pressure_force.set(i, {});
    bearing[i] = 0;
    if (i >= count || !transfer_.placed(p))
      continue;
    const double* const gas_at = after(p);
    seen.velocity.set(i, {gas_at[0], gas_at[1], gas_at[2]});
    if (bears) {
      seen.pressure_force.set(i, {gas_at[3], gas_at[4], gas_at[5]});
      bearing[i] = -sphere_volume(view.radius[p]);
    }
  }
  seen.pressure_force *= bearing;
  return seen;
}

} // namespace granflux::coupling
