// SPDX-FileCopyrightText: 2026 The GranFlux developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <granflux/cfd/gas_solver.hpp>
#include <granflux/coupling/coupler.hpp>

#include "charges.hpp"
#include "gas_at_particles.hpp"
#include "grid_transfer.hpp"

namespace granflux::coupling {

/// What the transfer of momentum and that of heat share. All must outlive it.
struct TransferParts {
  const CouplingOptions& options;
  const cfd::GasSolver& gas;
  GridTransfer& transfer;
  const GasAtParticles& at_particles;
  Charges& charges;

  [[nodiscard]] double particles_a_parcel() const {
    return options.coarse_graining * options.coarse_graining * options.coarse_graining;
  }
};

} // namespace granflux::coupling
