// SPDX-FileCopyrightText: 2026 The GranFlux developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <variant>
#include <vector>

#include <granflux/coupling/cube_shares.hpp>
#include <granflux/coupling/share_lists.hpp>

namespace granflux::coupling {

/// Shares of the particles of this rank in the gas cells around them. Depositing and sampling
/// use the same shares, so that one is the adjoint of the other: for particle values q and a
/// window field f
///
///   sum_p q_p sample(f)_p = sum_c deposit(q)_c f_c .
///
/// In both each result is summed by one thread at a time in a fixed order: the same bits for every
/// number of threads. Values may be of any type that consists of doubles, with zero T{}, += and
/// * double.
class Weights {
public:
  /// That can be numbered together with their cells.
  [[nodiscard]] static std::size_t most_particles(const AnyKernel& kernel,
                                                  const AnyLocator& locator);

  /// Renews the shares. Particles whose `coupled` entry is 0 (if given) are left out; so are those
  /// with their centre outside the grid, which are counted. The kernel must serve the locator, and
  /// particles be no more than most_particles().
  void build(const AnyKernel& kernel, const AnyLocator& locator, std::span<const Vec3> position,
             std::span<const double> radius, std::span<const std::uint8_t> coupled = {});

  [[nodiscard]] const Window& window() const { return placing_.window; }
  [[nodiscard]] std::size_t particles() const { return placed_.size(); }
  /// Coupled and inside the grid.
  [[nodiscard]] bool placed(std::size_t p) const { return placed_[p] != 0; }
  [[nodiscard]] std::size_t placed_count() const { return placing_.placed; }
  /// Particles meant to be coupled but outside the grid.
  [[nodiscard]] std::size_t outside_count() const { return placing_.outside; }

  /// field[c] = sum over particles of share * value. `field` has window().size() entries.
  template <class T> void deposit(std::span<const T> value, std::span<T> field) const {
    std::visit([&](const auto& shares) { shares.deposit(value, field); }, shares_);
  }
  /// value[p] = sum over cells of share * field; T{} for a particle that is not placed.
  template <class T> void sample(std::span<const T> field, std::span<T> value) const {
    std::visit([&](const auto& shares) { shares.sample(field, value); }, shares_);
  }

private:
  Placing placing_{.placed = 0, .outside = 0, .window = {}};
  std::vector<std::uint8_t> placed_;
  std::variant<ShareLists, CubeShares<2>, CubeShares<3>> shares_;
};

} // namespace granflux::coupling
