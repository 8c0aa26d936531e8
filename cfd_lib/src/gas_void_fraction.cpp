// SPDX-FileCopyrightText: 2026 The GranFlux developers
// SPDX-License-Identifier: BSD-3-Clause
#include "gas_state.hpp"

#include <algorithm>
#include <cmath>

#include <granflux/cfd/row_sweep.hpp>

namespace granflux::cfd {

/// The void fraction at the end of the step and what follows from it. Inertia moves with the fluxes
/// that will carry momentum in this step, so that a uniform velocity stays uniform however the void
/// fraction moves, and momentum is still conserved. Returns whether that left no inertia in a
/// cell: then it starts anew, from the void fraction itself.
bool GasSolver::Impl::move_void_fraction(double dt, const BlockFields& void_fraction) {
  eps_rate_noise = 1e-13 / dt;
  double found[2] = {0, -1}; // whether anything changed; minus the least inertia
  for (std::size_t b = 0; b < mesh.local.size() && found[0] == 0; ++b)
    found[0] = max_cells(mesh.local[b].layout, 0, [&](std::ptrdiff_t c) {
      return void_fraction[b][c] == eps[b][c] ? 0.0 : 1.0;
    });
  MPI_Allreduce(MPI_IN_PLACE, found, 1, MPI_DOUBLE, MPI_MAX, mesh.comm);
  steps_at_rest = found[0] == 0 ? steps_at_rest + 1 : 0;
  if (resting())
    return false;

  std::swap(eps_rate, eps_rate_old);
  // The rates that belong to the fluxes with which momentum is convected, and their weights: those
  // of the last two steps; or, where convection is implicit, of the last one and this one.
  const double of_last = ab_now, of_other = implicit ? 1 - ab_now : ab_old;
  for (std::size_t b = 0; b < mesh.local.size(); ++b)
    found[1] = std::max(
        found[1],
        max_cells(mesh.local[b].layout, found[1],
                  [&, now = void_fraction[b].data(), start = eps_start[b].data(),
                   end = eps[b].data(), middle = eps_middle[b].data(), rate = eps_rate[b].data(),
                   rate_old = eps_rate_old[b].data(), inertia_start = eps_inertia_start[b].data(),
                   inertia_end = eps_inertia[b].data()](std::ptrdiff_t c) {
                    start[c] = end[c];
                    end[c] = now[c];
                    middle[c] = 0.5 * (now[c] + start[c]);
                    const double rate_new = (now[c] - start[c]) / dt;
                    inertia_start[c] = inertia_end[c];
                    inertia_end[c] +=
                        dt * (of_last * rate_old[c] + of_other * (implicit ? rate_new : rate[c]));
                    rate[c] = rate_new;
                    return -inertia_end[c];
                  }));
  MPI_Allreduce(MPI_IN_PLACE, &found[1], 1, MPI_DOUBLE, MPI_MAX, mesh.comm);
  const bool restarted = found[1] >= 0;
  if (restarted) {
    eps_inertia = eps_start;
    if (!implicit)
      ab_now = 1, ab_old = 0;
  }
  halo.exchange({&eps_middle, &eps_start});
  boundaries.fill_zero_gradient(eps_middle);
  boundaries.fill_zero_gradient(eps_start);
  return restarted;
}

} // namespace granflux::cfd
