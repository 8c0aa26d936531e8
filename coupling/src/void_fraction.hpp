// SPDX-FileCopyrightText: 2026 The GranFlux developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include <granflux/coupling/ledger.hpp>

#include "grid_transfer.hpp"

namespace granflux::coupling {

/// The gas's share of each cell: 1 - S (sum_p w V_p / V).
class VoidFraction {
public:
  /// Below `floor` a cell stops the run. Throws ConfigError where it is none. The mesh must outlive
  /// this.
  VoidFraction(const cfd::Mesh& mesh, double floor);

  /// Of the particles that are placed. Throws NumericalError on all ranks alike where a cell has
  /// less than the floor. Collective.
  void find(const ParticleView& view, GridTransfer& transfer, ExchangeSums& sums);

  cfd::BlockFields field;

private:
  void check(ExchangeSums& sums) const;
  [[nodiscard]] std::string too_little_gas(std::size_t b, double least) const;

  const cfd::Mesh& mesh_;
  double floor_;
  std::vector<double> volume_; ///< of each particle, V_p [m3]
};

} // namespace granflux::coupling
