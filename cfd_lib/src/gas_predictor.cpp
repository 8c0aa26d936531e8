// SPDX-FileCopyrightText: 2026 The GranFlux developers
// SPDX-License-Identifier: BSD-3-Clause
#include "gas_state.hpp"

#include <algorithm>
#include <cmath>

#include <granflux/cfd/error.hpp>
#include <granflux/cfd/row_sweep.hpp>

namespace granflux::cfd {

/// Boussinesq: the weight that the gas has less, or more, than at the reference temperature.
void GasSolver::Impl::add_thermal_buoyancy() {
  thermal_buoyancy = {};
  if (!energy || energy->properties().expansion == 0)
    return;
  const Energy& properties = energy->properties();
  const Vec3 slope = -fluid.density * properties.expansion * fluid.gravity; // N/(m3 K)
  for (std::size_t b = 0; b < mesh.local.size(); ++b) {
    const Block& block = mesh.local[b];
    const Field& temperature = energy->temperature()[b];
    const auto lift = [&](std::ptrdiff_t c) {
      return eps_start[b][c] * (temperature[c] - properties.reference_temperature);
    };
    for_cells(block.layout, [&](std::ptrdiff_t c) {
      for (std::size_t m = 0; m < 3; ++m)
        r[b][m][c] += lift(c) * slope[int(m)];
    });
    thermal_buoyancy +=
        sum_cells(block.layout, [&](std::ptrdiff_t c) { return lift(c) * block.volume[c]; }) *
        slope;
  }
}

DiffusionSolver::Unknown GasSolver::Impl::component(std::size_t m) {
  return {"momentum equation: component " + std::string(1, "xyz"[m]),
          [this, m](std::size_t b) -> Field& { return u[b][m]; },
          [this, m](BlockFields& q) { boundaries.fill_velocity_correction(q, int(m)); }};
}

/// The part of the momentum equation that the new velocity does not change: leaves a, share and r
/// with old momentum (set before the inertia moved), convection, half the old friction, drag.
void GasSolver::Impl::begin_momentum(double dt, const MomentumExchange* exchange) {
  boundary_convection = ab_now * outflow + ab_old * outflow_old;
  for (std::size_t m = 0; m < 3; ++m)
    boundary_friction[int(m)] =
        0.5 * viscous_force(m, [&](std::size_t b) -> Field& { return friction[b][m]; });
  const double rho_dt = fluid.density / dt;
  for (std::size_t b = 0; b < mesh.local.size(); ++b) {
    const Block& block = mesh.local[b];
    for (std::size_t m = 0; m < 3; ++m)
      for_cells(block.layout, [&](std::ptrdiff_t c) {
        r[b][m][c] -= (ab_now * convection[b][m][c] + ab_old * convection_old[b][m][c] -
                       0.5 * friction[b][m][c]) /
                      block.volume[c];
      });
    for_cells(block.layout, [&](std::ptrdiff_t c) { a[b][c] = rho_dt * eps_inertia[b][c]; });
    if (!exchange) {
      share[b] = eps_start[b];
    } else {
      share[b] = exchange->pressure_fraction[b];
      for_cells(block.layout, [&](std::ptrdiff_t c) {
        a[b][c] += exchange->drag_coefficient[b][c];
        for (std::size_t m = 0; m < 3; ++m)
          r[b][m][c] += exchange->drag_source[b][m][c];
      });
    }
    for_cells(block.layout, [&](std::ptrdiff_t c) { inertia[b][c] = a[b][c] * block.volume[c]; });
  }
}

/// Momentum without the new pressure, Crank-Nicolson for friction: leaves r, with which the new
/// velocity will be (r - share grad p) / a.
void GasSolver::Impl::predict(double new_time, StepReport& report) {
  constexpr int most_passes = 100;
  // Where cells are not orthogonal the solver knows a part of friction only: the defect of the
  // whole is made small in several passes.
  const bool once = mesh.orthogonal && eddy_viscosity.empty();
  std::array<double, 3> scale{};
  diffusion_solver.set_operator(inertia, conductance);
  for (int pass = 0; pass < most_passes; ++pass) {
    if (pass > 0)
      halo.exchange(u);
    boundaries.fill_velocity(u, eps_middle, new_time); // the new boundary values
    update_velocity_gradient();
    bool good = true;
    for (std::size_t m = 0; m < 3; ++m) {
      viscous_force(m, [&](std::size_t b) -> Field& { return defect[b]; });
      double sums[2] = {0, 0}; // squares: of the equation's terms, of its defect
      for (std::size_t b = 0; b < mesh.local.size(); ++b) {
        const Layout& layout = mesh.local[b].layout;
        const auto [terms, left] =
            sum_rows<2>(layout, room,
                        [v = u[b][m].data(), right = r[b][m].data(), chi = share[b].data(),
                         grad = grad_p[b][m].data(), mass = inertia[b].data(), d = defect[b].data(),
                         volume = mesh.local[b].volume.data(),
                         n = layout.cells[0]](std::ptrdiff_t row, int, int) {
                          double squares = 0, defects = 0;
#pragma omp simd reduction(+ : squares, defects)
                          for (std::ptrdiff_t c = row; c < row + n; ++c) {
                            const double rhs = (right[c] - chi[c] * grad[c]) * volume[c];
                            const double size = std::abs(rhs) + mass[c] * std::abs(v[c]);
                            d[c] = rhs - mass[c] * v[c] + 0.5 * d[c];
                            squares += size * size;
                            defects += d[c] * d[c];
                          }
                          return std::array<double, 2>{squares, defects};
                        });
        sums[0] += terms, sums[1] += left;
      }
      MPI_Allreduce(MPI_IN_PLACE, sums, 2, MPI_DOUBLE, MPI_SUM, mesh.comm);
      if (!std::isfinite(sums[0]))
        check_finite(); // names the cell and throws
      if (pass == 0)
        scale[m] = std::sqrt(sums[0]);
      const double enough = numerics.viscous_tolerance * scale[m], size = std::sqrt(sums[1]);
      if (size <= enough)
        continue;
      good = false;
      report.viscous_iterations =
          std::max(report.viscous_iterations,
                   diffusion_solver.solve(component(m), defect,
                                          once ? enough : std::max(enough, 0.05 * size)));
    }
    if (once || good)
      return;
  }
  throw NumericalError("momentum equation: friction did not converge in " +
                       std::to_string(most_passes) +
                       " passes: the mesh is too far from orthogonal for this time step");
}

/// The friction that is applied is the divergence of what the solver arrived at, so momentum
/// closes whatever the solver's tolerance.
void GasSolver::Impl::add_new_friction(double new_time) {
  halo.exchange(u);
  boundaries.fill_velocity(u, eps_middle, new_time);
  update_velocity_gradient();
  for (std::size_t m = 0; m < 3; ++m) {
    boundary_friction[int(m)] +=
        0.5 * viscous_force(m, [&](std::size_t b) -> Field& { return spread[b]; });
    for (std::size_t b = 0; b < mesh.local.size(); ++b) {
      const Block& block = mesh.local[b];
      for_cells(block.layout,
                [&](std::ptrdiff_t c) { r[b][m][c] += 0.5 * spread[b][c] / block.volume[c]; });
    }
  }
}

} // namespace granflux::cfd
