// SPDX-FileCopyrightText: 2026 The GranFlux developers
// SPDX-License-Identifier: BSD-3-Clause
#include "gas_state.hpp"

#include <algorithm>
#include <cmath>

#include <granflux/cfd/error.hpp>

namespace granflux::cfd {

/// The converged velocity's own convection and friction, as sums of fluxes: momentum closes
/// whatever the tolerance.
void GasSolver::Impl::close_implicit(double new_time, const MomentumExchange* exchange,
                                     StepReport& report) {
  r = implicit->fixed;
  for (std::size_t b = 0; b < mesh.local.size(); ++b)
    for (std::size_t m = 0; m < 3; ++m)
      for_cells(mesh.local[b].layout, [&](std::ptrdiff_t c) {
        r[b][m][c] -= 0.5 * implicit->convection[b][m][c] / mesh.local[b].volume[c];
      });
  boundary_convection += 0.5 * implicit->outflow;
  add_new_friction(new_time);
  project(new_time, Drive::given, exchange, report);
}

/// Crank-Nicolson for convection as well: momentum and pressure are solved in turn until the
/// momentum equation holds with the velocity, the fluxes and the pressure of the new time.
void GasSolver::Impl::iterate_implicit(double new_time, const MomentumExchange* exchange,
                                       StepReport& report) {
  constexpr int most_iterations = 200;
  constexpr double reduction = 0.1; // of the defect by one solution: the rest is out of date
  ImplicitMomentum& state = *implicit;
  state.fixed = r;
  boundaries.fill_velocity(u, eps_middle, new_time);
  double worst = 0;
  for (int iteration = 1; iteration <= most_iterations; ++iteration) {
    update_velocity_gradient();
    state.outflow = convect_momentum(state.convection);
    std::array<double, 6> squares{}; // of each component's terms, of its defect
    for (std::size_t m = 0; m < 3; ++m) {
      viscous_force(m, defect[m]);
      for (std::size_t b = 0; b < mesh.local.size(); ++b) {
        const Block& block = mesh.local[b];
        Field& left = defect[m][b];
        for_cells(block.layout, [&](std::ptrdiff_t c) {
          const double rhs =
              (state.fixed[b][m][c] - share[b][c] * grad_p[b][m][c]) * block.volume[c];
          left[c] = rhs - inertia[b][c] * u[b][m][c] + 0.5 * (left[c] - state.convection[b][m][c]);
        });
        squares[m] += sum_cells(block.layout, [&](std::ptrdiff_t c) {
          const double size = std::abs(state.fixed[b][m][c]) * block.volume[c] +
                              std::abs(share[b][c] * grad_p[b][m][c]) * block.volume[c] +
                              inertia[b][c] * std::abs(u[b][m][c]);
          return size * size;
        });
        squares[m + 3] +=
            sum_cells(block.layout, [&](std::ptrdiff_t c) { return left[c] * left[c]; });
      }
    }
    MPI_Allreduce(MPI_IN_PLACE, squares.data(), 6, MPI_DOUBLE, MPI_SUM, mesh.comm);
    // All components by one measure: one of them may be at rest.
    const double scale = std::sqrt(squares[0] + squares[1] + squares[2]);
    worst = std::sqrt(squares[3] + squares[4] + squares[5]);
    if (!std::isfinite(scale + worst))
      check_finite(); // names the cell and throws
    if (iteration > 1 && worst <= numerics.implicit_tolerance * scale) {
      close_implicit(new_time, exchange, report);
      return;
    }
    worst = scale > 0 ? worst / scale : 0;

    state.solver.set_operator(inertia, conductance, flux, fluid.density);
    for (std::size_t m = 0; m < 3; ++m) {
      report.viscous_iterations = std::max(
          report.viscous_iterations, state.solver.solve(component(m), defect[m], reduction,
                                                        0.1 * numerics.implicit_tolerance * scale));
      // What this velocity would be made of; its own terms take their place in the end.
      for (std::size_t b = 0; b < mesh.local.size(); ++b)
        for_cells(mesh.local[b].layout, [&](std::ptrdiff_t c) {
          r[b][m][c] = a[b][c] * u[b][m][c] + share[b][c] * grad_p[b][m][c];
        });
    }
    if (!mesh.orthogonal) {
      halo.exchange(u);
      boundaries.fill_velocity(u, eps_middle, new_time);
      update_velocity_gradient();
    }
    project(new_time, Drive::given, exchange, report);
    report.outer_iterations = iteration;
  }
  throw NumericalError(
      "gas: step " + std::to_string(steps + 1) + ", time " + std::to_string(time) +
      " s: the implicit scheme did not converge in " + std::to_string(most_iterations) +
      " iterations (defect " + std::to_string(worst) + " of the momentum equation's terms, " +
      std::to_string(numerics.implicit_tolerance) + " wanted): use a smaller time step");
}

} // namespace granflux::cfd
