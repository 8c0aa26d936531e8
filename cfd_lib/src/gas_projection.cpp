// SPDX-FileCopyrightText: 2026 The GranFlux developers
// SPDX-License-Identifier: BSD-3-Clause
#include "gas_state.hpp"

#include <cmath>

#include <granflux/cfd/error.hpp>
#include <granflux/cfd/face_sum.hpp>

#include "block_geometry.hpp"

namespace granflux::cfd {

/// Without an outlet the right-hand side must sum to zero, or the pressure equation has no
/// solution. Round-off is spread evenly; more than that is the user's to mend.
void GasSolver::Impl::make_solvable() {
  double sums[3] = {0, 0, 0}; // imbalance, gross fluxes, volume
  for (std::size_t b = 0; b < mesh.local.size(); ++b) {
    const Block& block = mesh.local[b];
    sums[0] += sum_cells(block.layout, [&](std::ptrdiff_t c) { return system.rhs[b][c]; });
    sums[1] += sum_cells(block.layout, [&](std::ptrdiff_t c) {
      double gross = 0;
      for (std::size_t d = 0; d < 3; ++d)
        gross += std::abs(flux[b][d][c]) + std::abs(flux[b][d][c + block.layout.stride[d]]);
      return gross;
    });
    sums[2] += sum_cells(block.layout, [&](std::ptrdiff_t c) { return block.volume[c]; });
  }
  MPI_Allreduce(MPI_IN_PLACE, sums, 3, MPI_DOUBLE, MPI_SUM, mesh.comm);
  if (std::abs(sums[0]) > 1e-9 * sums[1] + eps_rate_noise * sums[2])
    throw NumericalError(
        "gas: the domain has no outlet, but " + std::to_string(sums[0] * 1e6) +
        " cm3/s must leave it (inlets, or particles inserted or deleted): add an outlet");
  for (std::size_t b = 0; b < mesh.local.size(); ++b)
    for_cells(mesh.local[b].layout, [&](std::ptrdiff_t c) {
      system.rhs[b][c] -= sums[0] / sums[2] * mesh.local[b].volume[c];
    });
}

/// Fluxes with the pressure as it is, and the coefficients and the right-hand side of the equation
/// for its increment. The momentum equation itself is interpolated, so resistances add up in
/// series.
void GasSolver::Impl::interpolate_momentum(double new_time, Drive drive) {
  const Vec3 driving = drive == Drive::given ? fluid.driving_pressure_gradient : Vec3{};
  for (std::size_t b = 0; b < mesh.local.size(); ++b) {
    const Block& block = mesh.local[b];
    for (std::size_t d = 0; d < 3; ++d) {
      const std::ptrdiff_t s = block.layout.stride[d];
      const Field& w = block.weight[d];
      for_faces(block.layout, int(d), [&, s](std::ptrdiff_t f) {
        const double eps_f = on_face(eps_middle[b], w, f, s), share_f = on_face(share[b], w, f, s);
        const double mobility = eps_f / on_face(a[b], w, f, s);
        double carried = 0;
        for (std::size_t m = 0; m < 3; ++m)
          carried += (on_face(r[b][m], w, f, s) - share_f * driving[int(m)]) * block.area[d][m][f];
        const double coefficient = mobility * share_f * block.conductance[d][f];
        flux[b][d][f] = mobility * carried - coefficient * (p[b][f] - p[b][f - s]);
        system.coefficient[b][d][f] = coefficient;
        if (!block.skew)
          return;
        flux[b][d][f] -=
            mobility * share_f * along(block.skew->cross[d], pressure_slope[b], w, f, s);
        for (std::size_t m = 0; m < 3; ++m) // from where the interpolation is to the face's centre
          flux[b][d][f] += eps_f * block.area[d][m][f] *
                           along(block.skew->offset[d], velocity_gradient[m][b], w, f, s);
      });
    }
  }
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
  double squares = 0; // of the gross fluxes, whose rounding is all that a steady state leaves
  for (std::size_t b = 0; b < mesh.local.size(); ++b) {
    const Block& block = mesh.local[b];
    const FaceSum net(block.layout, flux[b]);
    const auto [si, sj, sk] = block.layout.stride;
    const auto& [fi, fj, fk] = flux[b];
    squares += sum_cells(block.layout, [&, si = si, sj = sj, sk = sk, &fi = fi, &fj = fj,
                                        &fk = fk](std::ptrdiff_t c) {
      const double stored = block.volume[c] * eps_rate[b][c];
      system.rhs[b][c] = net(c) + stored;
      const double gross = std::abs(fi[c + si]) + std::abs(fi[c]) + std::abs(fj[c + sj]) +
                           std::abs(fj[c]) + std::abs(fk[c + sk]) + std::abs(fk[c]) +
                           std::abs(stored);
      return gross * gross;
    });
  }
  MPI_Allreduce(MPI_IN_PLACE, &squares, 1, MPI_DOUBLE, MPI_SUM, mesh.comm);
  system.scale = std::sqrt(squares);
  if (!boundaries.has_outlet())
    make_solvable();
}

/// Pressure equation and correction: from a, r, share and the void fraction's rate to fluxes,
/// pressure and velocity that satisfy continuity.
void GasSolver::Impl::project(double new_time, Drive drive, const MomentumExchange* exchange,
                              StepReport& report) {
  halo.exchange({&a, &share});
  halo.exchange(r);
  boundaries.fill_zero_gradient(a);
  boundaries.fill_zero_gradient(share);
  const int corrections = mesh.orthogonal ? 0 : numerics.pressure_corrections;
  for (int pass = 0; pass <= corrections; ++pass) {
    interpolate_momentum(new_time, drive);
    BlockFields& increment = defect; // free again: its work was done in predict()
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
      const Block& block = mesh.local[b];
      for (std::size_t d = 0; d < 3; ++d) {
        const std::ptrdiff_t s = block.layout.stride[d];
        for_faces(block.layout, int(d), [&, s](std::ptrdiff_t f) {
          flux[b][d][f] -= system.coefficient[b][d][f] * (increment[b][f] - increment[b][f - s]);
        });
      }
      for_cells(block.layout, [&](std::ptrdiff_t c) { p[b][c] += increment[b][c]; });
    }
    if (exchange) {
      set_drag_slope(*exchange);
      has_drag = true;
    }
    set_pressure_gradient(drive);
  }

  for (std::size_t b = 0; b < mesh.local.size(); ++b)
    for (std::size_t m = 0; m < 3; ++m)
      for_cells(mesh.local[b].layout, [&](std::ptrdiff_t c) {
        u[b][m][c] = (r[b][m][c] - share[b][c] * grad_p[b][m][c]) / a[b][c];
      });
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

/// driving + 1/V sum of face(direction, position, stride) S over the faces of each cell.
template <class Face>
void set_gradient(const Block& block, Face&& face, const Vec3& driving, VectorField& out) {
  const auto [si, sj, sk] = block.layout.stride;
  const auto& [ai, aj, ak] = block.area;
  for_cells(block.layout,
            [&, si = si, sj = sj, sk = sk, &ai = ai, &aj = aj, &ak = ak](std::ptrdiff_t c) {
              const double low_i = face(0, c, si), high_i = face(0, c + si, si);
              const double low_j = face(1, c, sj), high_j = face(1, c + sj, sj);
              const double low_k = face(2, c, sk), high_k = face(2, c + sk, sk);
              for (std::size_t m = 0; m < 3; ++m)
                out[m][c] = driving[int(m)] +
                            (high_i * ai[m][c + si] - low_i * ai[m][c] + high_j * aj[m][c + sj] -
                             low_j * aj[m][c] + high_k * ak[m][c + sk] - low_k * ak[m][c]) /
                                block.volume[c];
            });
}

} // namespace

void GasSolver::Impl::set_pressure_gradient(Drive drive) {
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
    const auto add = [&](auto&& face) { set_gradient(block, face, driving, grad_p[b]); };
    const auto straight = [&](std::size_t d, std::ptrdiff_t f, std::ptrdiff_t s) {
      return on_face(p[b], block.weight[d], f, s);
    };
    if (!has_drag && !block.skew) {
      add(straight);
      continue;
    }
    const auto& slope = drag_slope[b];
    add([&](std::size_t d, std::ptrdiff_t f, std::ptrdiff_t s) {
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

} // namespace granflux::cfd
