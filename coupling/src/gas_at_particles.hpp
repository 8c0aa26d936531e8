// SPDX-FileCopyrightText: 2026 The GranFlux developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include <granflux/cfd/gas_solver.hpp>
#include <granflux/coupling/particle_block.hpp>

#include "grid_transfer.hpp"

namespace granflux::coupling {

/// A block of particles as the laws of drag and heat transfer see it. Places without a particle,
/// and particles that are not placed, are in gas alone, without slip.
struct SeenBlock {
  Lanes there;    ///< 1 or 0
  Lanes diameter; ///< of particles, not of parcels [m]; 0 where there is none
  Lanes reynolds, void_fraction;
};

/// How many of those that are there a law is not meant for.
template <class Inside> double count_outside(const SeenBlock& seen, Inside&& inside) {
  double count = 0;
#pragma omp simd reduction(+ : count)
  for (std::size_t i = 0; i < particles_a_block; ++i)
    count += inside(i) ? 0 : seen.there[i];
  return count;
}

/// effective_coefficient() of a block, lambda = b T/m.
[[nodiscard]] Lanes effective_coefficients(const Lanes& b, const Lanes& lambda);

/// The gas sampled at each particle, before and after a gas step.
class GasAtParticles {
public:
  /// All must outlive this.
  GasAtParticles(const CouplingOptions& options, const cfd::GasSolver& gas, GridTransfer& transfer);

  /// Collective, as all that samples.
  void sample_before(const cfd::BlockFields& void_fraction);
  void sample_after();

  /// Before the step.
  [[nodiscard]] double void_fraction(std::size_t p) const { return before_[4 * p]; }
  [[nodiscard]] Vec3 velocity_before(std::size_t p) const {
    return {before_[4 * p + 1], before_[4 * p + 2], before_[4 * p + 3]};
  }
  [[nodiscard]] SeenBlock see_before(const ParticleView& view, std::size_t first,
                                     std::size_t count) const;

  /// After the step [K]; where the gas has an energy equation.
  [[nodiscard]] double temperature(std::size_t p) const { return after(p)[flow_numbers()]; }
  struct Push {
    VectorLanes velocity;       ///< m/s
    VectorLanes pressure_force; ///< N
  };
  [[nodiscard]] Push push(const ParticleView& view, std::size_t first, std::size_t count) const;
  /// As if there were no particles in the gas.
  [[nodiscard]] SeenBlock see_alone(const ParticleView& view, std::size_t first,
                                    std::size_t count) const;

private:
  template <class Gas>
  SeenBlock see(const ParticleView& view, std::size_t first, std::size_t count, Gas&& gas_at) const;
  [[nodiscard]] std::size_t flow_numbers() const {
    return options_.effects.pressure_gradient ? 6 : 3;
  }
  [[nodiscard]] std::size_t after_numbers() const {
    return flow_numbers() + (gas_.temperature() ? 1 : 0);
  }
  [[nodiscard]] const double* after(std::size_t p) const {
    return after_.data() + after_numbers() * p;
  }

  const CouplingOptions& options_;
  const cfd::GasSolver& gas_;
  GridTransfer& transfer_;
  double diameter_over_radius_;           ///< diameter of a particle over the radius of its parcel
  std::vector<const cfd::Field*> fields_; ///< to be sampled
  std::vector<double> before_;            ///< eps, u
  /// u; grad p where there are pressure forces; the temperature where there is an energy equation.
  std::vector<double> after_;
};

} // namespace granflux::coupling
