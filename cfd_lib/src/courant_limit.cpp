// SPDX-FileCopyrightText: 2026 The GranFlux developers
// SPDX-License-Identifier: BSD-3-Clause
#include <granflux/cfd/courant_limit.hpp>

#include <algorithm>
#include <cmath>

#include <granflux/cfd/sweep.hpp>

#include "block_geometry.hpp"

namespace granflux::cfd {

double courant_limit(const Numerics& numerics) {
  if (numerics.time_scheme == TimeScheme::implicit)
    return Bound::none;
  switch (numerics.convection) {
  case ConvectionScheme::upwind2:
    return 0.25; // the wave of two cells: its eigenvalue -4 C meets the end of the real axis, -1
  case ConvectionScheme::limited:
    return 0.5; // first-order upwind, -2 C, at extrema; the mean of central and upwind2 elsewhere
  case ConvectionScheme::central:
    break;
  }
  return 0.3; // grows by C^4/4 a step, 0.2 % here, unless friction damps it
}

double hopeless_courant(const Numerics& numerics) {
  constexpr double times_limit = 100;
  return times_limit * courant_limit(numerics);
}

double courant_rate(const Mesh& mesh, const Vec3& velocity) {
  double largest = 0;
  for (const Block& block : mesh.local)
    largest = max_cells(block.layout, largest, [&](std::ptrdiff_t c) {
      double gross = 0;
      for (std::size_t d = 0; d < 3; ++d)
        for (const std::ptrdiff_t face : {c, c + block.layout.stride[d]})
          gross += std::abs(dot(velocity, get(block.area[d], face)));
      return 0.5 * gross / block.volume[c];
    });
  MPI_Allreduce(MPI_IN_PLACE, &largest, 1, MPI_DOUBLE, MPI_MAX, mesh.comm);
  return largest;
}

double courant_rate_of_inlets(const Mesh& mesh, const GasCase& gas_case) {
  double largest = 0;
  for (const BoundaryCondition& boundary : gas_case.boundaries)
    if (boundary.kind == BoundaryKind::inlet)
      largest = std::max(largest, courant_rate(mesh, boundary.velocity));
  return largest;
}

Bound courant_bound(const Numerics& numerics, std::function<std::string(double)> cure) {
  const double limit = courant_limit(numerics);
  if (std::isinf(limit))
    cure = [](double) { return "nothing needed: convection is implicit"; };
  return {.name = "gas Courant number",
          .limit = limit,
          .advised = 0.8 * limit,
          .cure = std::move(cure)};
}

Bound friction_bound() {
  return {.name = "gas friction number",
          .cure = [](double) { return "nothing needed: friction is implicit"; }};
}

} // namespace granflux::cfd
