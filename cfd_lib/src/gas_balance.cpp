// SPDX-FileCopyrightText: 2026 The GranFlux developers
// SPDX-License-Identifier: BSD-3-Clause
#include "gas_state.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include <granflux/cfd/row_sweep.hpp>

namespace granflux::cfd {

Vec3 GasSolver::Impl::momentum() {
  Vec3 total;
  for (std::size_t b = 0; b < mesh.local.size(); ++b) {
    const Layout& layout = mesh.local[b].layout;
    const auto [x, y, z] =
        sum_rows<3>(layout, room,
                    [ux = u[b][0].data(), uy = u[b][1].data(), uz = u[b][2].data(),
                     share_of_gas = eps_inertia[b].data(), volume = mesh.local[b].volume.data(),
                     n = layout.cells[0]](std::ptrdiff_t row, int, int) {
                      double mx = 0, my = 0, mz = 0;
#pragma omp simd reduction(+ : mx, my, mz)
                      for (std::ptrdiff_t c = row; c < row + n; ++c) {
                        const double gas = share_of_gas[c] * volume[c];
                        mx += gas * ux[c], my += gas * uy[c], mz += gas * uz[c];
                      }
                      return std::array<double, 3>{mx, my, mz};
                    });
    total += Vec3{x, y, z};
  }
  return fluid.density * total;
}

void GasSolver::Impl::take_balance(double dt, const MomentumExchange* exchange) {
  balance = {};
  const Vec3 old_momentum = std::exchange(own_momentum, momentum());
  balance.momentum = own_momentum;
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
  double volume = 0;
  for (std::size_t b = 0; b < mesh.local.size(); ++b) {
    const Layout& layout = mesh.local[b].layout;
    const Field& v = mesh.local[b].volume;
    const auto [change, space, x, y, z] =
        sum_rows<5>(layout, room, [&, n = layout.cells[0]](std::ptrdiff_t row, int, int) {
          double rate = 0, sum = 0;
          Vec3 force;
          for (std::ptrdiff_t c = row; c < row + n; ++c) {
            rate += eps_rate[b][c] * v[c];
            sum += v[c];
            for (std::size_t m = 0; m < 3; ++m)
              force[int(m)] += (1 - share[b][c]) * grad_p[b][m][c] * v[c];
          }
          if (exchange)
            for (std::ptrdiff_t c = row; c < row + n; ++c)
              for (std::size_t m = 0; m < 3; ++m)
                force[int(m)] += (exchange->drag_source[b][m][c] -
                                  exchange->drag_coefficient[b][c] * u[b][m][c]) *
                                 v[c];
          return std::array<double, 5>{rate, sum, force.x, force.y, force.z};
        });
    balance.gas_volume_change += change;
    volume += space;
    balance.exchange += Vec3{x, y, z};
  }
  balance.driving = -volume * fluid.driving_pressure_gradient;

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
    std::vector<std::array<double, 3>> rows(std::size_t(block.layout.cells[1]) *
                                            std::size_t(block.layout.cells[2]));
    for_rows(block.layout,
             [&, sj = sj, sk = sk, &fi = fi, &fj = fj, &fk = fk](std::ptrdiff_t row, int j, int k) {
               double residual = 0, scale = 0, courant = 0;
               const double *i = fi.data(), *jf = fj.data(), *kf = fk.data();
               const double *volume = block.volume.data(), *rate = eps_rate[b].data(),
                            *middle = eps_middle[b].data();
#pragma omp simd reduction(max : residual, scale, courant)
               for (std::ptrdiff_t c = row; c < row + block.layout.cells[0]; ++c) {
                 const double inverse = 1 / volume[c];
                 const double net = i[c + 1] - i[c] + jf[c + sj] - jf[c] + kf[c + sk] - kf[c];
                 const double gross = std::abs(i[c + 1]) + std::abs(i[c]) + std::abs(jf[c + sj]) +
                                      std::abs(jf[c]) + std::abs(kf[c + sk]) + std::abs(kf[c]);
                 residual = std::max(residual, std::abs(net * inverse + rate[c]));
                 scale = std::max(scale, gross * inverse);
                 courant = std::max(courant, 0.5 * dt * gross * inverse / middle[c]);
               }
               rows[std::size_t(j) + std::size_t(block.layout.cells[1]) * std::size_t(k)] = {
                   residual, scale, courant};
             });
    for (const auto& row : rows)
      for (std::size_t n = 0; n < 3; ++n)
        largest[n] = std::max(largest[n], row[n]);
  }
  MPI_Allreduce(MPI_IN_PLACE, largest, 3, MPI_DOUBLE, MPI_MAX, mesh.comm);
  report.continuity_residual = largest[0];
  report.continuity_scale = largest[1];
  report.courant = largest[2];
}

} // namespace granflux::cfd
