// SPDX-FileCopyrightText: 2026 The GranFlux developers
// SPDX-License-Identifier: BSD-3-Clause
#include "gas_state.hpp"

#include <cmath>

namespace granflux::cfd {

Vec3 GasSolver::Impl::momentum() const {
  Vec3 total;
  for (int m = 0; m < 3; ++m)
    total[m] = sum([&](std::size_t b, std::ptrdiff_t c) {
      return fluid.density * eps_inertia[b][c] * u[b][std::size_t(m)][c] * mesh.local[b].volume[c];
    });
  return total;
}

void GasSolver::Impl::take_balance(double dt, const MomentumExchange* exchange,
                                   const Vec3& old_momentum) {
  balance = {};
  balance.momentum = momentum();
  balance.thermal_buoyancy = thermal_buoyancy;
  balance.momentum_change = (balance.momentum - old_momentum) / dt;
  balance.convection = -boundary_convection;
  balance.friction = boundary_friction;
  for (const BoundaryPatch& patch : boundaries.patches()) {
    const auto b = std::size_t(patch.block), d = std::size_t(patch.direction);
    for (const BoundaryFace& face : patch.faces) {
      const double value = 0.5 * (p[b][face.cell] + p[b][face.ghost]);
      for (std::size_t m = 0; m < 3; ++m)
        balance.pressure[int(m)] -= patch.outward * value * mesh.local[b].area[d][m][face.face];
      balance.boundary_volume_flux += patch.outward * flux[b][d][face.face];
    }
  }
  balance.gas_volume_change = sum(
      [&](std::size_t b, std::ptrdiff_t c) { return eps_rate[b][c] * mesh.local[b].volume[c]; });
  const double volume =
      sum([&](std::size_t b, std::ptrdiff_t c) { return mesh.local[b].volume[c]; });
  balance.driving = -volume * fluid.driving_pressure_gradient;
  for (std::size_t m = 0; m < 3; ++m)
    balance.exchange[int(m)] = sum([&](std::size_t b, std::ptrdiff_t c) {
      double force = (1 - share[b][c]) * grad_p[b][m][c];
      if (exchange)
        force += exchange->drag_source[b][m][c] - exchange->drag_coefficient[b][c] * u[b][m][c];
      return force * mesh.local[b].volume[c];
    });

  std::array<double, 26> all;
  std::size_t n = 0;
  const auto pack = [&](const Vec3& v) { all[n++] = v.x, all[n++] = v.y, all[n++] = v.z; };
  const auto unpack = [&](Vec3& v) { v = {all[n], all[n + 1], all[n + 2]}, n += 3; };
  all[n++] = balance.gas_volume_change;
  all[n++] = balance.boundary_volume_flux;
  for (const Vec3* v :
       {&balance.momentum, &balance.momentum_change, &balance.convection, &balance.friction,
        &balance.pressure, &balance.driving, &balance.exchange, &balance.thermal_buoyancy})
    pack(*v);
  MPI_Allreduce(MPI_IN_PLACE, all.data(), int(n), MPI_DOUBLE, MPI_SUM, mesh.comm);
  n = 0;
  balance.gas_volume_change = all[n++];
  balance.boundary_volume_flux = all[n++];
  for (Vec3* v :
       {&balance.momentum, &balance.momentum_change, &balance.convection, &balance.friction,
        &balance.pressure, &balance.driving, &balance.exchange, &balance.thermal_buoyancy})
    unpack(*v);
  balance.momentum_residual = balance.momentum_change - balance.convection - balance.friction -
                              balance.pressure - balance.driving - balance.exchange -
                              balance.thermal_buoyancy;
  for (const Vec3* v :
       {&balance.momentum_change, &balance.convection, &balance.friction, &balance.pressure,
        &balance.driving, &balance.exchange, &balance.thermal_buoyancy})
    balance.momentum_scale += norm(*v);
  balance.momentum_scale += norm(balance.momentum) / dt;
}

/// Continuity residual and Courant number of the step just made.
void GasSolver::Impl::measure(double dt, StepReport& report) const {
  double largest[3] = {0, 0, 0};
  for (std::size_t b = 0; b < mesh.local.size(); ++b) {
    const Block& block = mesh.local[b];
    const auto [si, sj, sk] = block.layout.stride;
    const auto& [fi, fj, fk] = flux[b];
    const auto net = [&, si = si, sj = sj, sk = sk, &fi = fi, &fj = fj,
                      &fk = fk](std::ptrdiff_t c) {
      return fi[c + si] - fi[c] + fj[c + sj] - fj[c] + fk[c + sk] - fk[c];
    };
    const auto gross = [&, si = si, sj = sj, sk = sk, &fi = fi, &fj = fj,
                        &fk = fk](std::ptrdiff_t c) {
      return std::abs(fi[c + si]) + std::abs(fi[c]) + std::abs(fj[c + sj]) + std::abs(fj[c]) +
             std::abs(fk[c + sk]) + std::abs(fk[c]);
    };
    largest[0] = max_cells(block.layout, largest[0], [&](std::ptrdiff_t c) {
      return std::abs(net(c) / block.volume[c] + eps_rate[b][c]);
    });
    largest[1] = max_cells(block.layout, largest[1],
                           [&](std::ptrdiff_t c) { return gross(c) / block.volume[c]; });
    largest[2] = max_cells(block.layout, largest[2], [&](std::ptrdiff_t c) {
      return 0.5 * dt * gross(c) / (block.volume[c] * eps_middle[b][c]);
    });
  }
  MPI_Allreduce(MPI_IN_PLACE, largest, 3, MPI_DOUBLE, MPI_MAX, mesh.comm);
  report.continuity_residual = largest[0];
  report.continuity_scale = largest[1];
  report.courant = largest[2];
}

} // namespace granflux::cfd
