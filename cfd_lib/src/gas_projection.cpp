// SPDX-FileCopyrightText: 2026 The GranFlux developers
// SPDX-License-Identifier: BSD-3-Clause
#include "gas_state.hpp"

#include <cmath>

#include <granflux/cfd/error.hpp>
#include <granflux/cfd/row_sweep.hpp>

#include "block_geometry.hpp"

namespace granflux::cfd {

/// Fluxes with the pressure as it is, and the coefficients of the equation for its increment. The
/// momentum equation itself is interpolated, so resistances add up in series.
void GasSolver::Impl::interpolate_momentum(double new_time, Drive drive) {
  const Vec3 driving = drive == Drive::given ? fluid.driving_pressure_gradient : Vec3{};
  // Faces of a lattice look along its axes: one component is enough.
  const auto interpolate = [&]<bool aligned>(std::bool_constant<aligned>, std::size_t b,
                                             std::size_t d, std::ptrdiff_t row, int n) {
    const Block& block = mesh.local[b];
    const std::ptrdiff_t s = block.layout.stride[d];
    const double *w = block.weight[d].data(), *eps_of = eps_middle[b].data(),
                 *share_of = share[b].data(), *a_of = a[b].data(), *p_of = p[b].data(),
                 *conducts = block.conductance[d].data();
    const std::array<const double*, 3> right{r[b][0].data(), r[b][1].data(), r[b][2].data()};
    const std::array<const double*, 3> area{block.area[d][0].data(), block.area[d][1].data(),
                                            block.area[d][2].data()};
    double *through = flux[b][d].data(), *coefficient = system.coefficient[b][d].data();
    const auto at_face = [=](const double* q, std::ptrdiff_t f) {
      return q[f - s] + w[f] * (q[f] - q[f - s]);
    };
#pragma omp simd
    for (std::ptrdiff_t f = row; f < row + n; ++f) {
      const double share_f = at_face(share_of, f);
      const double mobility = at_face(eps_of, f) / at_face(a_of, f);
      double carried = 0;
      if constexpr (aligned)
        carried = (at_face(right[d], f) - share_f * driving[int(d)]) * area[d][f];
      else
        for (std::size_t m = 0; m < 3; ++m)
          carried += (at_face(right[m], f) - share_f * driving[int(m)]) * area[m][f];
      coefficient[f] = mobility * share_f * conducts[f];
      through[f] = mobility * carried - coefficient[f] * (p_of[f] - p_of[f - s]);
    }
    if (!block.skew)
      return;
    for (std::ptrdiff_t f = row; f < row + n; ++f) {
      const Field& weight = block.weight[d];
      const double eps_f = at_face(eps_of, f);
      through[f] -= eps_f / at_face(a_of, f) * at_face(share_of, f) *
                    along(block.skew->cross[d], pressure_slope[b], weight, f, s);
      for (std::size_t m = 0; m < 3; ++m) // from where the interpolation is to the face's centre
        through[f] += eps_f * area[m][f] *
                      along(block.skew->offset[d], velocity_gradient[m][b], weight, f, s);
    }
  };
  for (std::size_t b = 0; b < mesh.local.size(); ++b)
    for_face_rows(mesh.local[b].layout, [&](std::size_t d, std::ptrdiff_t row, int n) {
      if (mesh.lattice)
        interpolate(std::true_type{}, b, d, row, n);
      else
        interpolate(std::false_type{}, b, d, row, n);
    });
  for (const BoundaryPatch& patch : boundaries.patches()) {
    const auto b = std::size_t(patch.block), d = std::size_t(patch.direction);
    const Block& block = mesh.local[b];
    const BoundaryCondition& condition = boundaries.condition(patch);
    for (const BoundaryFace& face : patch.faces) {
      double& coefficient = system.coefficient[b][d][face.face];
      double& f = flux[b][d][face.face];
      if (condition.kind == BoundaryKind::outlet) { // half a cell to the given pressure
        const std::ptrdiff_t c = face.cell;
        const double mobility = eps_middle[b][c] / a[b][c];
        f = 0;
        for (std::size_t m = 0; m < 3; ++m)
          f +=
              mobility * block.area[d][m][face.face] * (r[b][m][c] - share[b][c] * driving[int(m)]);
        coefficient = 2 * mobility * share[b][c] * block.conductance[d][face.face];
        const double outside = drive == Drive::given ? condition.pressure : 0;
        f -= patch.outward * coefficient * (outside - p[b][c]);
        if (block.skew)
          f -= mobility * share[b][c] *
               dot(get(block.skew->cross[d], face.face), get(pressure_slope[b], c));
      } else {
        const Vec3 velocity = condition.kind == BoundaryKind::inlet
                                  ? boundaries.velocity(patch, face, new_time)
                                  : Vec3{};
        f = 0;
        for (std::size_t m = 0; m < 3; ++m)
          f += velocity[int(m)] * block.area[d][m][face.face];
        coefficient = 0;
      }
    }
  }
}

/// The right-hand side of the pressure equation: what the fluxes leave of continuity. Without an
/// outlet it must sum to zero, or there is no solution. Round-off is spread evenly; more than that
/// is the user's to mend.
void GasSolver::Impl::take_continuity() {
  double sums[4] = {0, 0, 0, 0}; // right-hand side, gross fluxes, their squares, volume
  for (std::size_t b = 0; b < mesh.local.size(); ++b) {
    const Block& block = mesh.local[b];
    const auto of_block = sum_rows<4>(
        block.layout, room,
        [fi = flux[b][0].data(), fj = flux[b][1].data(), fk = flux[b][2].data(),
         volume = block.volume.data(), rate = eps_rate[b].data(), rhs = system.rhs[b].data(),
         sj = block.layout.stride[1], sk = block.layout.stride[2],
         n = block.layout.cells[0]](std::ptrdiff_t row, int, int) {
          double total = 0, all = 0, squares = 0, space = 0;
#pragma omp simd reduction(+ : total, all, squares, space)
          for (std::ptrdiff_t c = row; c < row + n; ++c) {
            const double stored = volume[c] * rate[c];
            rhs[c] = fi[c + 1] - fi[c] + fj[c + sj] - fj[c] + fk[c + sk] - fk[c] + stored;
            const double gross = std::abs(fi[c + 1]) + std::abs(fi[c]) + std::abs(fj[c + sj]) +
                                 std::abs(fj[c]) + std::abs(fk[c + sk]) + std::abs(fk[c]) +
                                 std::abs(stored);
            total += rhs[c];
            all += gross;
            squares += gross * gross;
            space += volume[c];
          }
          return std::array<double, 4>{total, all, squares, space};
        });
    for (std::size_t n = 0; n < of_block.size(); ++n)
      sums[n] += of_block[n];
  }
  MPI_Allreduce(MPI_IN_PLACE, sums, 4, MPI_DOUBLE, MPI_SUM, mesh.comm);
  system.scale = std::sqrt(sums[2]); // its rounding is all that a steady state leaves
  if (boundaries.has_outlet())
    return;
  if (std::abs(sums[0]) > 1e-9 * sums[1] + eps_rate_noise * sums[3])
    throw NumericalError(
        "gas: the domain has no outlet, but " + std::to_string(sums[0] * 1e6) +
        " cm3/s must leave it (inlets, or particles inserted or deleted): add an outlet");
  for (std::size_t b = 0; b < mesh.local.size(); ++b)
    for_rows(mesh.local[b].layout,
             [rhs = system.rhs[b].data(), volume = mesh.local[b].volume.data(),
              mean = sums[0] / sums[3],
              n = mesh.local[b].layout.cells[0]](std::ptrdiff_t row, int, int) {
#pragma omp simd
               for (std::ptrdiff_t c = row; c < row + n; ++c)
                 rhs[c] -= mean * volume[c];
             });
}

/// Pressure equation and correction: from a, r, share and the void fraction's rate to fluxes,
/// pressure and velocity that satisfy continuity.
void GasSolver::Impl::project(double new_time, Drive drive, const MomentumExchange* exchange,
                              StepReport& report) {
  halo.exchange(r);
  const int corrections = mesh.orthogonal ? 0 : numerics.pressure_corrections;
  for (int pass = 0; pass <= corrections; ++pass) {
    interpolate_momentum(new_time, drive);
    take_continuity();
    BlockFields& increment = defect[0]; // free again: its work was done in predict()
    const PressureReport solved = pressure_solver->solve(system, increment);
    report.pressure_iterations += solved.iterations;
    report.pressure_residual = solved.residual;
    halo.exchange({&increment});
    for (const BoundaryPatch& patch : boundaries.patches()) {
      const auto b = std::size_t(patch.block), d = std::size_t(patch.direction);
      for (const BoundaryFace& face : patch.faces) {
        double& coefficient = system.coefficient[b][d][face.face];
        flux[b][d][face.face] += patch.outward * coefficient * increment[b][face.cell];
        coefficient = 0; // done: the sweep below is for interior faces
      }
    }
    for (std::size_t b = 0; b < mesh.local.size(); ++b) {
      const Layout& layout = mesh.local[b].layout;
      const double* more = increment[b].data();
      for_face_rows(layout, [&](std::size_t d, std::ptrdiff_t row, int n) {
        const std::ptrdiff_t s = layout.stride[d];
        const double* coefficient = system.coefficient[b][d].data();
        double* through = flux[b][d].data();
#pragma omp simd
        for (std::ptrdiff_t f = row; f < row + n; ++f)
          through[f] -= coefficient[f] * (more[f] - more[f - s]);
        if (d != 0)
          return;
        double* pressure = p[b].data();
#pragma omp simd
        for (std::ptrdiff_t c = row; c < row + layout.cells[0]; ++c)
          pressure[c] += more[c];
      });
    }
    if (exchange) {
      set_drag_slope(*exchange);
      has_drag = true;
    } else if (has_drag) {
      for (auto& slope : drag_slope)
        for (Field& component : slope)
          component.fill(0);
      has_drag = false;
    }
    set_pressure_gradient(drive, pass == corrections ? After::set_velocity : After::nothing);
  }
  halo.exchange(u);
  boundaries.fill_velocity(u, eps_middle, new_time);
}

/// The pressure gradient that balances the drag in each cell, for the face velocities as they
/// are: with it the pressure on a face between dense and dilute cells is that of two half cells
/// in series, not their mean, which would push the gas of the dilute one.
void GasSolver::Impl::set_drag_slope(const MomentumExchange& exchange) {
  for (std::size_t b = 0; b < mesh.local.size(); ++b) {
    const Block& block = mesh.local[b];
    for_cells(block.layout, [&](std::ptrdiff_t c) {
      // u = sum over faces of (x_face - x_cell) F / eps over the volume: exact for uniform flow.
      Vec3 velocity;
      for (std::size_t d = 0; d < 3; ++d) {
        const std::ptrdiff_t s = block.layout.stride[d];
        const auto add = [&](std::ptrdiff_t f, double outward, std::ptrdiff_t neighbour,
                             double share_of_way) {
          const double through = outward * flux[b][d][f] /
                                 on_face(eps_middle[b], block.weight[d], f, s) / block.volume[c];
          const double to_face = share_of_way * through;
          for (std::size_t m = 0; m < 3; ++m)
            velocity[int(m)] += to_face * (block.centre[m][neighbour] - block.centre[m][c]);
          if (block.skew)
            velocity += through * get(block.skew->offset[d], f);
        };
        add(c, -1, c - s, 1 - block.weight[d][c]);
        add(c + s, 1, c + s, block.weight[d][c + s]);
      }
      for (std::size_t m = 0; m < 3; ++m)
        drag_slope[b][m][c] =
            (exchange.drag_source[b][m][c] - exchange.drag_coefficient[b][c] * velocity[int(m)]) /
            share[b][c];
    });
  }
  halo.exchange(drag_slope);
  for (const BoundaryPatch& patch : boundaries.patches())
    for (const BoundaryFace& face : patch.faces)
      for (Field& component : drag_slope[std::size_t(patch.block)])
        component[face.ghost] = component[face.cell];
}

namespace {

/// driving + 1/V sum of face(direction, position, stride) S over the faces of the cells of a row.
template <bool aligned, class Face>
void set_gradient(const Block& block, const Face& face, const Vec3& driving, VectorField& out,
                  std::ptrdiff_t row) {
  const auto [si, sj, sk] = block.layout.stride;
  const double* volume = block.volume.data();
  const auto area = [&](std::size_t d, std::size_t m) { return block.area[d][m].data(); };
  if constexpr (aligned) {
    const double *ai = area(0, 0), *aj = area(1, 1), *ak = area(2, 2);
    double *x = out[0].data(), *y = out[1].data(), *z = out[2].data();
#pragma omp simd
    for (std::ptrdiff_t c = row; c < row + block.layout.cells[0]; ++c) {
      const double inverse = 1 / volume[c];
      x[c] = driving.x + (face(0, c + si, si) * ai[c + si] - face(0, c, si) * ai[c]) * inverse;
      y[c] = driving.y + (face(1, c + sj, sj) * aj[c + sj] - face(1, c, sj) * aj[c]) * inverse;
      z[c] = driving.z + (face(2, c + sk, sk) * ak[c + sk] - face(2, c, sk) * ak[c]) * inverse;
    }
  } else {
    for (std::ptrdiff_t c = row; c < row + block.layout.cells[0]; ++c) {
      const double low_i = face(0, c, si), high_i = face(0, c + si, si);
      const double low_j = face(1, c, sj), high_j = face(1, c + sj, sj);
      const double low_k = face(2, c, sk), high_k = face(2, c + sk, sk);
      for (std::size_t m = 0; m < 3; ++m) {
        const double *ai = area(0, m), *aj = area(1, m), *ak = area(2, m);
        out[m][c] = driving[int(m)] + (high_i * ai[c + si] - low_i * ai[c] + high_j * aj[c + sj] -
                                       low_j * aj[c] + high_k * ak[c + sk] - low_k * ak[c]) /
                                          volume[c];
      }
    }
  }
}

} // namespace

/// From the pressure; and from it the velocity, where that is asked for, while a row is in cache.
void GasSolver::Impl::set_pressure_gradient(Drive drive, After after) {
  halo.exchange({&p});
  boundaries.fill_pressure(p, drag_slope, drive == Drive::given);
  if (!mesh.orthogonal) {
    const FieldOf pressure = [this](std::size_t b) -> const Field& { return p[b]; };
    gradient(mesh, halo, boundaries, pressure, pressure_slope);
    boundaries.move_pressure_ghosts(p, pressure_slope);
    gradient(mesh, halo, boundaries, pressure, pressure_slope);
  }
  const Vec3 driving = drive == Drive::given ? fluid.driving_pressure_gradient : Vec3{};
  for (std::size_t b = 0; b < mesh.local.size(); ++b) {
    const Block& block = mesh.local[b];
    const auto sweep = [&](const auto& face) {
      for_rows(block.layout, [&](std::ptrdiff_t row, int, int) {
        if (mesh.lattice)
          set_gradient<true>(block, face, driving, grad_p[b], row);
        else
          set_gradient<false>(block, face, driving, grad_p[b], row);
        if (after == After::set_velocity)
          set_velocity(b, row);
      });
    };
    const auto straight = [pressure = p[b].data(),
                           w = std::array{block.weight[0].data(), block.weight[1].data(),
                                          block.weight[2].data()}](std::size_t d, std::ptrdiff_t f,
                                                                   std::ptrdiff_t s) {
      return pressure[f - s] + w[d][f] * (pressure[f] - pressure[f - s]);
    };
    if (!has_drag && !block.skew) {
      sweep(straight);
      continue;
    }
    const auto& slope = drag_slope[b];
    sweep([&](std::size_t d, std::ptrdiff_t f, std::ptrdiff_t s) {
      const double w = block.weight[d][f];
      double jump = 0; // (slope below - slope above) . (way from centre to centre)
      for (std::size_t m = 0; m < 3; ++m)
        jump += (slope[m][f - s] - slope[m][f]) * (block.centre[m][f] - block.centre[m][f - s]);
      double value = straight(d, f, s) + w * (1 - w) * jump;
      if (block.skew)
        value += along(block.skew->offset[d], pressure_slope[b], block.weight[d], f, s);
      return value;
    });
  }
}

/// The velocity of a row of cells, from r and the pressure gradient.
void GasSolver::Impl::set_velocity(std::size_t b, std::ptrdiff_t row) {
  const double *chi = share[b].data(), *inert = a[b].data();
  for (std::size_t m = 0; m < 3; ++m) {
    const double *right = r[b][m].data(), *grad = grad_p[b][m].data();
    double* v = u[b][m].data();
#pragma omp simd
    for (std::ptrdiff_t c = row; c < row + mesh.local[b].layout.cells[0]; ++c)
      v[c] = (right[c] - chi[c] * grad[c]) / inert[c];
  }
}

} // namespace granflux::cfd
