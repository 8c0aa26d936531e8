// SPDX-FileCopyrightText: 2026 The GranFlux developers
// SPDX-License-Identifier: BSD-3-Clause
#include "gas_state.hpp"

#include <algorithm>
#include <cmath>

#include <granflux/cfd/error.hpp>
#include <granflux/cfd/row_sweep.hpp>

namespace granflux::cfd {

/// Boussinesq: the weight that the gas has less, or more, than at the reference temperature, and
/// with it the drag's source, into r. Returns false where there is no buoyancy: r is untouched.
bool GasSolver::Impl::set_thermal_buoyancy(const MomentumExchange* exchange) {
  thermal_buoyancy = {};
  if (!energy || energy->properties().expansion == 0)
    return false;
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
        r[b][m][c] = lift(c) * slope[int(m)] + (exchange ? exchange->drag_source[b][m][c] : 0);
    });
    thermal_buoyancy +=
        sum_cells(block.layout, [&](std::ptrdiff_t c) { return lift(c) * block.volume[c]; }) *
        slope;
  }
  return true;
}

Unknown GasSolver::Impl::component(std::size_t m) {
  return {"momentum equation: component " + std::string(1, "xyz"[m]),
          [this, m](std::size_t b) -> Field& { return u[b][m]; },
          [this, m](const BoundaryPatch& patch, const BoundaryFace& face) {
            return boundaries.velocity_ghost_factor(patch, face, int(m));
          }};
}

/// What stays the same while nothing changes the medium: inertia and share, with their ghosts, and
/// the operator of friction, which eddies change in every step.
void GasSolver::Impl::set_medium(double dt, const MomentumExchange* exchange) {
  if (resting() && eddy_viscosity.empty() && dt == dt_old && !exchange && !exchanged)
    return;
  exchanged = exchange != nullptr;
  const double rho_dt = fluid.density / dt;
  for (std::size_t b = 0; b < mesh.local.size(); ++b) {
    const Field& volume = mesh.local[b].volume;
    share[b] = exchange ? exchange->pressure_fraction[b] : eps_start[b];
    for_cells(mesh.local[b].layout, [&](std::ptrdiff_t c) {
      a[b][c] = rho_dt * eps_inertia[b][c] + (exchange ? exchange->drag_coefficient[b][c] : 0);
      inertia[b][c] = a[b][c] * volume[c];
    });
  }
  halo.exchange({&a, &share});
  boundaries.fill_zero_gradient(a);
  boundaries.fill_zero_gradient(share);
  if (!implicit)
    diffusion_solver.set_operator(inertia, conductance);
}

/// Friction on cell c for component m of the velocity as it is, where that is all: (b, m)(c).
auto GasSolver::Impl::spread_by_faces() {
  return [this](std::size_t b, std::size_t m) {
    return [spread = Diffusion(mesh.local[b].layout, conductance[b]),
            v = u[b][m].data()](std::ptrdiff_t c) { return spread(v, c); };
  };
}

/// The same where viscous_force() left it.
auto GasSolver::Impl::spread_in_defect() {
  return [this](std::size_t b, std::size_t m) {
    return [force = defect[m][b].data()](std::ptrdiff_t c) { return force[c]; };
  };
}

/// Sets r and the defect of the momentum equation from what leaves cell c with the flow,
/// convected(b, m)(c), and the friction on it, spread(b, m)(c) [N], and keeps the former. `source`
/// is added where it is given.
template <class Convected, class Spread>
void GasSolver::Impl::set_momentum(double dt, const BlockVectors* source, Convected&& convected,
                                   Spread&& spread) {
  const double rho_dt = fluid.density / dt;
  squares_of_terms = {};
  for (std::size_t b = 0; b < mesh.local.size(); ++b) {
    const Layout& layout = mesh.local[b].layout;
    const double *before = eps_inertia_start[b].data(), *mass = inertia[b].data(),
                 *volume = mesh.local[b].volume.data(), *chi = share[b].data();
    const auto row_of = [&, n = layout.cells[0]]<bool has_source>(
                            std::bool_constant<has_source>, std::size_t m, std::ptrdiff_t row) {
      const double *v = u[b][m].data(), *grad = grad_p[b][m].data(),
                   *old = convection_old[b][m].data(),
                   *given = has_source ? (*source)[b][m].data() : nullptr;
      double *now = convection[b][m].data(), *right = r[b][m].data(), *d = defect[m][b].data();
      const auto leaves = convected(b, m);
      const auto friction = spread(b, m);
      double squares = 0;
#pragma omp simd reduction(+ : squares)
      for (std::ptrdiff_t c = row; c < row + n; ++c) {
        const double out = leaves(c), half_friction = 0.5 * friction(c);
        double force = half_friction - (ab_now * out + ab_old * old[c]);
        if constexpr (has_source)
          force += given[c] * volume[c];
        const double density = rho_dt * before[c] * v[c] + force / volume[c];
        const double rhs = (density - chi[c] * grad[c]) * volume[c];
        const double size = std::abs(rhs) + mass[c] * std::abs(v[c]);
        now[c] = out;
        right[c] = density;
        d[c] = rhs - mass[c] * v[c] + half_friction;
        squares += size * size;
      }
      return squares;
    };
    const std::array<double, 3> of_block =
        sum_rows<3>(layout, room, [&](std::ptrdiff_t row, int, int) {
          std::array<double, 3> squares{};
          for (std::size_t m = 0; m < 3; ++m)
            squares[m] =
                source ? row_of(std::true_type{}, m, row) : row_of(std::false_type{}, m, row);
          return squares;
        });
    for (std::size_t m = 0; m < 3; ++m)
      squares_of_terms[m] += of_block[m];
  }
}

/// The part of the momentum equation that the new velocity does not change: leaves a, share and r
/// with old momentum, convection, half the old friction, drag, and the defect of the velocity as
/// it is.
void GasSolver::Impl::begin_momentum(double dt, const MomentumExchange* exchange) {
  const BlockVectors* source = exchange ? &exchange->drag_source : nullptr;
  if (set_thermal_buoyancy(exchange)) // into r
    source = &r;
  outflow = {};
  if (mesh.orthogonal && eddy_viscosity.empty()) { // all in one sweep
    with_scheme(numerics.convection, [&]<class Scheme>(Scheme scheme) {
      const auto convected = [&](std::size_t b, std::size_t m) {
        return [flow = Convection<Scheme>(mesh.local[b].layout, flux[b], mesh.local[b].weight),
                density = fluid.density,
                v = u[b][m].data()](std::ptrdiff_t c) { return density * flow(v, c); };
      };
      set_momentum(dt, source, convected, spread_by_faces());
      for (std::size_t m = 0; m < 3; ++m) {
        outflow[int(m)] = convect_boundaries(
            scheme, mesh, boundaries, flux, carried_momentum(m, convection),
            [&](const BoundaryPatch& patch, const BoundaryFace& face, double more) {
              const auto b = std::size_t(patch.block);
              convection[b][m][face.cell] += more;
              r[b][m][face.cell] -= ab_now * more / mesh.local[b].volume[face.cell];
              defect[m][b][face.cell] -= ab_now * more;
            });
        boundary_friction[int(m)] = 0.5 * friction_at_boundaries(m);
      }
    });
  } else {
    outflow = convect_momentum(convection);
    for (std::size_t m = 0; m < 3; ++m)
      boundary_friction[int(m)] = 0.5 * viscous_force(m, defect[m]);
    set_momentum(
        dt, source,
        [&](std::size_t b, std::size_t m) {
          return [out = convection[b][m].data()](std::ptrdiff_t c) { return out[c]; };
        },
        spread_in_defect());
  }
  boundary_convection = ab_now * outflow + ab_old * outflow_old;
}

/// Takes new values at the boundaries into the velocity's ghosts and, by way of friction, into the
/// defect.
void GasSolver::Impl::move_boundaries(double new_time) {
  const auto add = [&](double factor) {
    for (const BoundaryPatch& patch : boundaries.patches()) {
      const auto b = std::size_t(patch.block);
      const Field& g = conductance[b][std::size_t(patch.direction)];
      for (std::size_t m = 0; m < 3; ++m)
        for (const BoundaryFace& face : patch.faces)
          defect[m][b][face.cell] += factor * g[face.face] * u[b][m][face.ghost];
    }
  };
  add(-0.5);
  boundaries.fill_velocity(u, eps_middle, new_time);
  add(0.5);
}

/// Momentum without the new pressure, Crank-Nicolson for friction: leaves r, with which the new
/// velocity will be (r - share grad p) / a.
void GasSolver::Impl::predict(double new_time, StepReport& report) {
  constexpr int most_passes = 100;
  // Where cells are not orthogonal the solver knows a part of friction only: the defect of the
  // whole is made small in several passes. Otherwise it takes more than one only where single
  // precision is not enough.
  const bool once = mesh.orthogonal && eddy_viscosity.empty();
  MPI_Allreduce(MPI_IN_PLACE, squares_of_terms.data(), 3, MPI_DOUBLE, MPI_SUM, mesh.comm);
  std::array<double, 3> scale{};
  for (int pass = 0; pass < most_passes; ++pass) {
    if (pass == 0) {
      move_boundaries(new_time);
    } else {
      halo.exchange(u);
      boundaries.fill_velocity(u, eps_middle, new_time);
    }
    if (pass > 0 || !once) {
      update_velocity_gradient();
      for (std::size_t m = 0; m < 3; ++m)
        viscous_force(m, defect[m]);
      take_defect();
    }
    std::array<double, 3> squares{};
    for (std::size_t m = 0; m < 3; ++m)
      for (std::size_t b = 0; b < mesh.local.size(); ++b)
        squares[m] += sum_rows<1>(mesh.local[b].layout, room,
                                  [d = defect[m][b].data(), n = mesh.local[b].layout.cells[0]](
                                      std::ptrdiff_t row, int, int) {
                                    double sum = 0;
#pragma omp simd reduction(+ : sum)
                                    for (std::ptrdiff_t c = row; c < row + n; ++c)
                                      sum += d[c] * d[c];
                                    return std::array{sum};
                                  })[0];
    MPI_Allreduce(MPI_IN_PLACE, squares.data(), 3, MPI_DOUBLE, MPI_SUM, mesh.comm);
    if (!std::isfinite(squares[0] + squares[1] + squares[2]))
      check_finite(); // names the cell and throws
    bool good = true;
    for (std::size_t m = 0; m < 3; ++m) {
      const double size = std::sqrt(squares[m]);
      if (pass == 0)
        scale[m] = std::sqrt(squares_of_terms[m] + squares[m]);
      const double enough = numerics.viscous_tolerance * scale[m];
      if (size <= enough)
        continue;
      const auto [iterations, left] = diffusion_solver.correct(
          component(m), defect[m], size, once ? enough : std::max(enough, 0.05 * size));
      report.viscous_iterations = std::max(report.viscous_iterations, iterations);
      good = good && once && left <= enough;
    }
    if (good)
      return;
  }
  throw NumericalError("momentum equation: friction did not converge in " +
                       std::to_string(most_passes) +
                       " passes: the mesh is too far from orthogonal for this time step");
}

/// What the velocity as it is leaves of the momentum equation, from the friction in `defect`.
void GasSolver::Impl::take_defect() {
  for (std::size_t b = 0; b < mesh.local.size(); ++b)
    for_rows(mesh.local[b].layout,
             [&, n = mesh.local[b].layout.cells[0]](std::ptrdiff_t row, int, int) {
               for (std::size_t m = 0; m < 3; ++m) {
                 const double *v = u[b][m].data(), *right = r[b][m].data(), *chi = share[b].data(),
                              *grad = grad_p[b][m].data(), *mass = inertia[b].data(),
                              *volume = mesh.local[b].volume.data();
                 double* d = defect[m][b].data();
#pragma omp simd
                 for (std::ptrdiff_t c = row; c < row + n; ++c)
                   d[c] = (right[c] - chi[c] * grad[c]) * volume[c] - mass[c] * v[c] + 0.5 * d[c];
               }
             });
}

/// The friction that is applied is the divergence of what the solver arrived at, so momentum
/// closes whatever the solver's tolerance.
void GasSolver::Impl::add_new_friction(double new_time) {
  halo.exchange(u);
  boundaries.fill_velocity(u, eps_middle, new_time);
  update_velocity_gradient();
  const auto add = [&](auto&& spread) {
    for (std::size_t b = 0; b < mesh.local.size(); ++b)
      for_rows(mesh.local[b].layout,
               [&, n = mesh.local[b].layout.cells[0]](std::ptrdiff_t row, int, int) {
                 const double* volume = mesh.local[b].volume.data();
                 for (std::size_t m = 0; m < 3; ++m) {
                   double* right = r[b][m].data();
                   const auto friction = spread(b, m);
#pragma omp simd
                   for (std::ptrdiff_t c = row; c < row + n; ++c)
                     right[c] += 0.5 * friction(c) / volume[c];
                 }
               });
  };
  if (mesh.orthogonal && eddy_viscosity.empty()) {
    for (std::size_t m = 0; m < 3; ++m)
      boundary_friction[int(m)] += 0.5 * friction_at_boundaries(m);
    add(spread_by_faces());
  } else {
    for (std::size_t m = 0; m < 3; ++m)
      boundary_friction[int(m)] += 0.5 * viscous_force(m, defect[m]);
    add(spread_in_defect());
  }
}

} // namespace granflux::cfd
