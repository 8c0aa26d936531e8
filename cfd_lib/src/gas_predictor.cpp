// SPDX-FileCopyrightText: 2026 The GranFlux developers
// SPDX-License-Identifier: BSD-3-Clause
#include "gas_state.hpp"

#include <algorithm>
#include <cmath>

#include <granflux/cfd/error.hpp>

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
  for (int pass = 0; pass < most_passes; ++pass) {
    if (pass > 0)
      halo.exchange(u);
    boundaries.fill_velocity(u, eps_middle, new_time); // the new boundary values
    update_velocity_gradient();
    bool good = true;
    for (std::size_t m = 0; m < 3; ++m) {
      viscous_force(m, [&](std::size_t b) -> Field& { return spread[b]; });
      double sums[2] = {0, 0}; // squares: of the equation's terms, of its defect
      for (std::size_t b = 0; b < mesh.local.size(); ++b) {
        const Field& volume = mesh.local[b].volume;
        const Layout& layout = mesh.local[b].layout;
        for_cells(layout, [&](std::ptrdiff_t c) {
          const double rhs = (r[b][m][c] - share[b][c] * grad_p[b][m][c]) * volume[c];
          defect[b][c] = rhs - inertia[b][c] * u[b][m][c] + 0.5 * spread[b][c];
        });
        sums[0] += sum_cells(layout, [&](std::ptrdiff_t c) {
          const double rhs = (r[b][m][c] - share[b][c] * grad_p[b][m][c]) * volume[c];
          const double size = std::abs(rhs) + inertia[b][c] * std::abs(u[b][m][c]);
          return size * size;
        });
        if (!once)
          sums[1] +=
              sum_cells(layout, [&](std::ptrdiff_t c) { return defect[b][c] * defect[b][c]; });
      }
      MPI_Allreduce(MPI_IN_PLACE, sums, 2, MPI_DOUBLE, MPI_SUM, mesh.comm);
      if (!std::isfinite(sums[0]))
        check_finite(); // names the cell and throws
      if (pass == 0)
        scale[m] = std::sqrt(sums[0]);
      if (scale[m] == 0)
        continue;
      const double size = std::sqrt(sums[1]) / scale[m];
      if (!once && size <= numerics.viscous_tolerance)
        continue;
      good = false;
      const double enough =
          once ? numerics.viscous_tolerance : std::max(numerics.viscous_tolerance, 0.05 * size);
      report.viscous_iterations = std::max(
          report.viscous_iterations,
          diffusion_solver.solve(component(m), inertia, conductance, defect, scale[m], enough));
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
