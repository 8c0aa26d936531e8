// SPDX-FileCopyrightText: 2026 The GranFlux developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include <granflux/cfd/mesh.hpp>
#include <granflux/coupling/coupler.hpp>
#include <granflux/coupling/kernel/kernels.hpp>
#include <granflux/coupling/locate.hpp>
#include <granflux/coupling/smoothing.hpp>
#include <granflux/coupling/weights.hpp>
#include <granflux/coupling/window_exchange.hpp>

namespace granflux::coupling {

/// K numbers of one particle or one window cell, deposited and sampled together.
template <std::size_t K> struct Values {
  std::array<double, K> of{};

  Values& operator+=(const Values& o) & {
    for (std::size_t k = 0; k < K; ++k)
      of[k] += o.of[k];
    return *this;
  }
  friend Values operator*(Values a, double s) {
    for (double& x : a.of)
      x *= s;
    return a;
  }
};

/// Carries numbers between the particles of this rank and the gas cells of all: by the shares that
/// the void-fraction kernel gives them, smoothed where the kernel asks for it. Symbols as in
/// docs/theory_coupling.md: w share of a particle in a cell, S smoothing.
class GridTransfer {
public:
  /// Mesh, halo and times must outlive this. Throws ConfigError where the kernel does not serve the
  /// grid, or its width is none.
  GridTransfer(const cfd::Mesh& mesh, const cfd::Halo& halo, const CouplingOptions& options,
               CouplingTimes& times);

  /// That a rank may have.
  [[nodiscard]] std::size_t most_particles() const {
    return Weights::most_particles(kernel_, locator_);
  }
  /// Finds the cells of the particles and their shares. Collective.
  void locate(const ParticleView& view);

  /// work := S (sum_p w q_p / V): K numbers of each particle, K fields. Collective.
  template <std::size_t K> void deposit(std::span<const double> values);
  /// values := sum_c w (S f)_c: of each local block K fields, K numbers of each particle. `work`
  /// may be overwritten. Collective.
  template <std::size_t K>
  void sample(std::span<const cfd::Field* const> fields, std::span<double> values);
  /// What deposit() leaves on gas cells.
  std::array<cfd::BlockFields, 7> work;

  [[nodiscard]] const Weights& weights() const { return weights_; }
  /// Coupled and inside the grid.
  [[nodiscard]] bool placed(std::size_t p) const { return weights_.placed(p); }
  /// Of any rank. Collective.
  [[nodiscard]] bool any_placed() const;
  [[nodiscard]] const GridExtent& extent() const;
  [[nodiscard]] long numbers_sent() const { return exchange_.numbers_sent(); }

  /// What the width of smoothing counts in [m]; 0 until particles have been seen.
  [[nodiscard]] double smoothing_diameter() const { return smoothing_diameter_; }
  void restore_smoothing_diameter(double diameter);

private:
  void choose_smoothing(const ParticleView& view);
  template <std::size_t K> void smooth();
  template <std::size_t K>
  std::vector<const cfd::Field*> smoothed(std::span<const cfd::Field* const> fields);
  template <std::size_t K> std::span<Values<K>> window();

  const cfd::Mesh& mesh_;
  const cfd::Halo& halo_;
  CouplingTimes& times_;
  AnyLocator locator_;
  AnyKernel kernel_;
  Weights weights_;
  WindowExchange exchange_;
  double smoothing_width_; ///< in diameters
  std::optional<Smoothing> smoothing_;
  double smoothing_diameter_ = 0;
  std::vector<double> window_values_;
};

} // namespace granflux::coupling
