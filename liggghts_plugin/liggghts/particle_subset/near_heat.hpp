// SPDX-FileCopyrightText: 2026 The GranFlux developers
// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

#include <optional>
#include <span>
#include <vector>

#include <granflux/coupling/near_heat/gas_gap.hpp>

#include "contact_heat.hpp"
#include "contact_lists.hpp"
#include "particles.hpp"

namespace granflux::particle_subset {

/// Effects between particles that need not touch. Empty: off.
struct NearHeatOptions {
  std::optional<coupling::GasGap> gas_gap;
  std::optional<double> surroundings; ///< temperature that particles radiate to [K]

  [[nodiscard]] bool any() const { return gas_gap || surroundings; }
  /// Gap up to which particles as large as `radius` notice each other [m].
  [[nodiscard]] double reach(double radius) const;
};

/// Conduction through the gas in gaps and radiation (docs/theory_heat.md), along the lists of the
/// contacts, which must hold the pairs up to the reach. Particles take contributions in an order
/// that does not depend on the threads.
class NearHeat {
public:
  NearHeat() = default;
  /// `emissivity`: of types from 1 on; of use where there is radiation.
  NearHeat(const NearHeatOptions& options, std::vector<double> emissivity);

  /// Adds what the particles of one thread receive. Positions as of the contacts of this step.
  void add(const Particles& particles, const ThreadContacts& contacts, const HeatArrays& arrays,
           HeatSums& sums, std::span<double> facing) const;

private:
  class Thread;

  NearHeatOptions options_;
  std::vector<double> emissivity_;
};

} // namespace granflux::particle_subset
