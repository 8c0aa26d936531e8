// SPDX-FileCopyrightText: 2026 The GranFlux developers
// SPDX-License-Identifier: BSD-3-Clause
#include "gas_state.hpp"

#include <algorithm>
#include <cmath>

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
      return eps_middle[b][c] * (temperature[c] - properties.reference_temperature);
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

void GasSolver::Impl::set_conductance() {
  for (std::size_t b = 0; b < mesh.local.size(); ++b) {
    const Block& block = mesh.local[b];
    for (std::size_t d = 0; d < 3; ++d)
      for_faces(block.layout, int(d), [&](std::ptrdiff_t f) {
        conductance[b][d][f] = fluid.viscosity * block.conductance[d][f] *
                               on_face(eps_middle[b], block.weight[d], f, block.layout.stride[d]);
      });
  }
}

/// Viscous force of the boundaries on the gas, this rank, for the velocity as it is [N].
Vec3 GasSolver::Impl::boundary_friction() const {
  Vec3 force;
  for (const BoundaryPatch& patch : boundaries.patches()) {
    const auto b = std::size_t(patch.block), d = std::size_t(patch.direction);
    for (const BoundaryFace& face : patch.faces)
      for (int m = 0; m < 3; ++m)
        force[m] += conductance[b][d][face.face] *
                    (u[b][std::size_t(m)][face.ghost] - u[b][std::size_t(m)][face.cell]);
  }
  return force;
}

DiffusionSolver::Unknown GasSolver::Impl::component(std::size_t m) {
  return {"momentum equation: component " + std::string(1, "xyz"[m]),
          [this, m](std::size_t b) -> Field& { return u[b][m]; },
          [this, m](BlockFields& q) { boundaries.fill_velocity_correction(q, int(m)); }};
}

/// Momentum without the new pressure: leaves a and r, with which the new velocity will be
/// (r - share grad p) / a.
void GasSolver::Impl::predict(double dt, const MomentumExchange* exchange, double new_time,
                              StepReport& report) {
  const double rho_dt = fluid.density / dt;
  // r so far: old momentum (set before the inertia moved), convection, half the old friction.
  for (std::size_t b = 0; b < mesh.local.size(); ++b) {
    const Block& block = mesh.local[b];
    for (std::size_t m = 0; m < 3; ++m) {
      diffusion(block.layout, conductance[b], u[b][m], friction[b][m]);
      for_cells(block.layout, [&](std::ptrdiff_t c) {
        r[b][m][c] -= (ab_now * convection[b][m][c] + ab_old * convection_old[b][m][c] -
                       0.5 * friction[b][m][c]) /
                      block.volume[c];
      });
    }
    for_cells(block.layout, [&](std::ptrdiff_t c) { a[b][c] = rho_dt * eps_inertia[b][c]; });
    if (!exchange) {
      share[b] = eps_middle[b];
      continue;
    }
    share[b] = exchange->pressure_fraction[b];
    for_cells(block.layout, [&](std::ptrdiff_t c) {
      a[b][c] += exchange->drag_coefficient[b][c];
      for (std::size_t m = 0; m < 3; ++m)
        r[b][m][c] += exchange->drag_source[b][m][c];
    });
  }
  for (std::size_t b = 0; b < mesh.local.size(); ++b)
    for_cells(mesh.local[b].layout,
              [&](std::ptrdiff_t c) { inertia[b][c] = a[b][c] * mesh.local[b].volume[c]; });

  boundaries.fill_velocity(u, eps_middle, new_time); // the new boundary values
  for (std::size_t m = 0; m < 3; ++m) {
    for (std::size_t b = 0; b < mesh.local.size(); ++b)
      diffusion(mesh.local[b].layout, conductance[b], u[b][m], spread[b]);
    double scale = 0;
    for (std::size_t b = 0; b < mesh.local.size(); ++b) {
      const Field& volume = mesh.local[b].volume;
      const Layout& layout = mesh.local[b].layout;
      for_cells(layout, [&](std::ptrdiff_t c) {
        const double rhs = (r[b][m][c] - share[b][c] * grad_p[b][m][c]) * volume[c];
        defect[b][c] = rhs - inertia[b][c] * u[b][m][c] + 0.5 * spread[b][c];
      });
      scale += sum_cells(layout, [&](std::ptrdiff_t c) {
        const double rhs = (r[b][m][c] - share[b][c] * grad_p[b][m][c]) * volume[c];
        const double size = std::abs(rhs) + inertia[b][c] * std::abs(u[b][m][c]);
        return size * size;
      });
    }
    MPI_Allreduce(MPI_IN_PLACE, &scale, 1, MPI_DOUBLE, MPI_SUM, mesh.comm);
    if (!std::isfinite(scale))
      check_finite(); // names the cell and throws
    if (scale > 0)
      report.viscous_iterations =
          std::max(report.viscous_iterations,
                   diffusion_solver.solve(component(m), inertia, conductance, defect,
                                          std::sqrt(scale), numerics.viscous_tolerance));
  }
  // The friction that is applied is the divergence of what the solver arrived at, so momentum
  // closes whatever the solver's tolerance.
  halo.exchange(u);
  boundaries.fill_velocity(u, eps_middle, new_time);
  for (std::size_t b = 0; b < mesh.local.size(); ++b) {
    const Block& block = mesh.local[b];
    for (std::size_t m = 0; m < 3; ++m) {
      diffusion(block.layout, conductance[b], u[b][m], spread[b]);
      for_cells(block.layout,
                [&](std::ptrdiff_t c) { r[b][m][c] += 0.5 * spread[b][c] / block.volume[c]; });
    }
  }
}

} // namespace granflux::cfd
