// SPDX-FileCopyrightText: 2026 The GranFlux developers
// SPDX-License-Identifier: BSD-3-Clause
#include <granflux/cfd/gas_solver.hpp>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>

#include <granflux/cfd/boundary.hpp>
#include <granflux/cfd/convection.hpp>
#include <granflux/cfd/error.hpp>
#include <granflux/cfd/halo.hpp>
#include <granflux/cfd/pressure_solver.hpp>
#include <granflux/cfd/sweep.hpp>
#include <granflux/cfd/viscous_solver.hpp>

// Symbols as in docs/theory.md: eps void fraction, F = eps u.S volume flux through a face, a the
// implicit inertia rho eps'/dt + beta, r the right-hand side without the pressure, both per volume.

namespace granflux::cfd {

namespace {

using FaceFields = std::vector<std::array<Field, 3>>; ///< per local block and direction

FaceFields make_faces(const Mesh& mesh) {
  FaceFields faces;
  for (const Block& block : mesh.local)
    faces.push_back({Field(block.layout), Field(block.layout), Field(block.layout)});
  return faces;
}

/// Linear interpolation to the face below position f.
double on_face(const Field& q, const Field& weight, std::ptrdiff_t f, std::ptrdiff_t stride) {
  return q[f - stride] + weight[f] * (q[f] - q[f - stride]);
}

/// Whether given pressures (outlets, driving gradient) act, or, for the initial projection, not.
enum class Drive { none, given };

} // namespace

MomentumExchange make_exchange(const Mesh& mesh) {
  return {make_fields(mesh), make_vectors(mesh), make_fields(mesh, 1)};
}

struct GasSolver::Impl {
  Impl(const Mesh& m, const GasCase& c)
      : mesh(m), fluid(c.fluid), numerics(c.numerics), halo(m), boundaries(m, c.boundaries),
        viscous(m, halo, boundaries),
        pressure_solver(
            make_eigen_pressure_solver(m, !boundaries.has_outlet(), c.numerics.pressure_tolerance)),
        eps(make_fields(m, 1)), eps_middle(make_fields(m, 1)), eps_inertia(make_fields(m, 1)),
        eps_rate(make_fields(m)), eps_rate_old(make_fields(m)), u(make_vectors(m)),
        p(make_fields(m)), grad_p(make_vectors(m)), drag_slope(make_vectors(m)),
        flux(make_faces(m)), convection(make_vectors(m)), convection_old(make_vectors(m)),
        friction(make_vectors(m)), a(make_fields(m)), r(make_vectors(m)), share(make_fields(m, 1)),
        inertia(make_fields(m)), defect(make_fields(m)), spread(make_fields(m)),
        face_work(make_faces(m)), conductance(make_faces(m)) {
    for (std::size_t b = 0; b < mesh.local.size(); ++b)
      system.coefficient.push_back(
          {Field(mesh.local[b].layout), Field(mesh.local[b].layout), Field(mesh.local[b].layout)});
    system.rhs = make_fields(mesh);
  }

  // The step, in order.
  void extrapolate_inertia(double dt);
  void convect();
  template <class Scheme> void convect(const Scheme& scheme);
  void set_conductance();
  Vec3 boundary_friction() const;
  void predict(double dt, const MomentumExchange* exchange, double new_time, StepReport& report);
  void project(double new_time, Drive drive, const MomentumExchange* exchange, StepReport& report);
  void make_solvable();
  void set_drag_slope(const MomentumExchange& exchange);
  void set_pressure_gradient(Drive drive);
  void check_finite() const;
  void take_balance(double dt, const MomentumExchange* exchange, const Vec3& friction_force,
                    const Vec3& old_momentum);

  [[nodiscard]] Vec3 momentum() const;
  [[nodiscard]] std::string cell_name(std::int64_t encoded) const;
  template <class Term> double sum(Term&& term) const {
    double total = 0;
    for (std::size_t b = 0; b < mesh.local.size(); ++b)
      total += sum_cells(mesh.local[b].layout, [&](std::ptrdiff_t c) { return term(b, c); });
    return total;
  }
  template <class Term> double max(double least, Term&& term) const {
    double largest = least;
    for (std::size_t b = 0; b < mesh.local.size(); ++b)
      largest =
          max_cells(mesh.local[b].layout, largest, [&](std::ptrdiff_t c) { return term(b, c); });
    return largest;
  }
  template <class Visit> void visit_state(Visit&& visit);

  const Mesh& mesh;
  Fluid fluid;
  Numerics numerics;
  Halo halo;
  Boundaries boundaries;
  ViscousSolver viscous;
  std::unique_ptr<PressureSolver> pressure_solver;

  double time = 0, dt_old = 0;
  long steps = 0;
  bool has_history = false;
  double ab_now = 1, ab_old = 0; ///< Adams-Bashforth weights of this step

  BlockFields eps;         ///< end of the last step
  BlockFields eps_middle;  ///< mean over the present step
  BlockFields eps_inertia; ///< carried by the convecting fluxes: what holds the gas's momentum
  BlockFields eps_rate, eps_rate_old; ///< d eps/dt that the last two fluxes satisfy [1/s]
  double eps_rate_noise = 0;          ///< round-off of its mean, at most [1/s]
  BlockVectors u;
  BlockFields p;
  BlockVectors grad_p;                     ///< driving part included
  BlockVectors drag_slope;                 ///< pressure gradient that balances the drag [Pa/m]
  FaceFields flux;                         ///< F [m3/s], along +direction
  BlockVectors convection, convection_old; ///< momentum leaving each cell [N]
  Vec3 outflow, outflow_old;               ///< of it, through the boundaries [N]
  BlockVectors friction;                   ///< viscous force on each cell, Crank-Nicolson mean [N]
  BlockFields a;                           ///< kg/(m3 s)
  BlockVectors r;                          ///< N/m3
  BlockFields share;                       ///< of the pressure gradient that the gas bears
  BlockFields inertia, defect, spread;
  FaceFields face_work, conductance;
  PressureSystem system;
  Balance balance;
};

/// Inertia moves with the fluxes that will carry momentum in this step, so that a uniform velocity
/// stays uniform however the void fraction moves, and momentum is still conserved.
void GasSolver::Impl::extrapolate_inertia(double dt) {
  for (std::size_t b = 0; b < mesh.local.size(); ++b)
    for_cells(mesh.local[b].layout, [&](std::ptrdiff_t c) {
      eps_inertia[b][c] += dt * (ab_now * eps_rate[b][c] + ab_old * eps_rate_old[b][c]);
    });
}

template <class Scheme> void GasSolver::Impl::convect(const Scheme& scheme) {
  const double rho = fluid.density;
  for (std::size_t m = 0; m < 3; ++m) {
    for (std::size_t b = 0; b < mesh.local.size(); ++b) {
      const Block& block = mesh.local[b];
      const Field& q = u[b][m];
      for (std::size_t d = 0; d < 3; ++d) {
        const std::ptrdiff_t s = block.layout.stride[d];
        const Field &f = flux[b][d], &w = block.weight[d];
        Field& carried = face_work[b][d];
        for_faces(block.layout, int(d), [&, s](std::ptrdiff_t c) {
          const double value = f[c] >= 0 ? scheme(q[c - 2 * s], q[c - s], q[c], w[c])
                                         : scheme(q[c + s], q[c], q[c - s], 1 - w[c]);
          carried[c] = rho * f[c] * value;
        });
      }
    }
    double through = 0;
    for (const BoundaryPatch& patch : boundaries.patches()) {
      const auto b = std::size_t(patch.block), d = std::size_t(patch.direction);
      const bool outlet = boundaries.condition(patch).kind == BoundaryKind::outlet;
      for (const BoundaryFace& face : patch.faces) {
        const double f = flux[b][d][face.face];
        double value = 0.5 * (u[b][m][face.cell] + u[b][m][face.ghost]);
        if (outlet && f * patch.outward < 0)
          value = 0; // backflow: gas outside is at rest
        face_work[b][d][face.face] = rho * f * value;
        through += patch.outward * face_work[b][d][face.face];
      }
    }
    outflow[int(m)] = through;
    for (std::size_t b = 0; b < mesh.local.size(); ++b) {
      const auto [si, sj, sk] = mesh.local[b].layout.stride;
      const auto& [fi, fj, fk] = face_work[b];
      Field& out = convection[b][m];
      for_cells(mesh.local[b].layout,
                [&, si = si, sj = sj, sk = sk, &fi = fi, &fj = fj, &fk = fk](std::ptrdiff_t c) {
                  out[c] = fi[c + si] - fi[c] + fj[c + sj] - fj[c] + fk[c + sk] - fk[c];
                });
    }
  }
}

void GasSolver::Impl::convect() {
  std::swap(convection, convection_old);
  outflow_old = outflow;
  switch (numerics.convection) {
  case ConvectionScheme::central:
    return convect(Central{});
  case ConvectionScheme::upwind2:
    return convect(Upwind2{});
  case ConvectionScheme::limited:
    return convect(Limited{});
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

/// Momentum without the new pressure: leaves a and r, with which the new velocity will be
/// (r - share grad p) / a, and the mean viscous force in `friction`.
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
                   viscous.solve(int(m), inertia, conductance, defect, std::sqrt(scale),
                                 numerics.viscous_tolerance, u));
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

/// Pressure equation and correction: from a, r, share and the void fraction's rate to fluxes,
/// pressure and velocity that satisfy continuity.
void GasSolver::Impl::project(double new_time, Drive drive, const MomentumExchange* exchange,
                              StepReport& report) {
  const Vec3 driving = drive == Drive::given ? fluid.driving_pressure_gradient : Vec3{};
  halo.exchange({&a, &share});
  halo.exchange(r);
  boundaries.fill_zero_gradient(a);
  boundaries.fill_zero_gradient(share);
  for (std::size_t b = 0; b < mesh.local.size(); ++b) {
    const Block& block = mesh.local[b];
    for (std::size_t d = 0; d < 3; ++d) {
      const std::ptrdiff_t s = block.layout.stride[d];
      const Field& w = block.weight[d];
      for_faces(block.layout, int(d), [&, s](std::ptrdiff_t f) {
        // The momentum equation itself is interpolated, so resistances add up in series.
        const double eps_f = on_face(eps_middle[b], w, f, s), share_f = on_face(share[b], w, f, s);
        const double mobility = eps_f / on_face(a[b], w, f, s);
        double carried = 0;
        for (std::size_t m = 0; m < 3; ++m)
          carried += (on_face(r[b][m], w, f, s) - share_f * driving[int(m)]) * block.area[d][m][f];
        const double coefficient = mobility * share_f * block.conductance[d][f];
        flux[b][d][f] = mobility * carried - coefficient * (p[b][f] - p[b][f - s]);
        system.coefficient[b][d][f] = coefficient;
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
  for (std::size_t b = 0; b < mesh.local.size(); ++b) {
    const Block& block = mesh.local[b];
    const auto [si, sj, sk] = block.layout.stride;
    const auto& [fi, fj, fk] = flux[b];
    for_cells(block.layout,
              [&, si = si, sj = sj, sk = sk, &fi = fi, &fj = fj, &fk = fk](std::ptrdiff_t c) {
                system.rhs[b][c] = fi[c + si] - fi[c] + fj[c + sj] - fj[c] + fk[c + sk] - fk[c] +
                                   block.volume[c] * eps_rate[b][c];
              });
  }
  if (!boundaries.has_outlet())
    make_solvable();

  BlockFields& increment = defect; // free again: its work was done in predict()
  const PressureReport solved = pressure_solver->solve(system, increment);
  report.pressure_iterations = solved.iterations;
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
  if (exchange)
    set_drag_slope(*exchange);
  set_pressure_gradient(drive);

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
                                 on_face(eps_middle[b], block.weight[d], f, s) * share_of_way /
                                 block.volume[c];
          for (std::size_t m = 0; m < 3; ++m)
            velocity[int(m)] += through * (block.centre[m][neighbour] - block.centre[m][c]);
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

void GasSolver::Impl::set_pressure_gradient(Drive drive) {
  halo.exchange({&p});
  boundaries.fill_pressure(p, drag_slope, drive == Drive::given);
  const Vec3 driving = drive == Drive::given ? fluid.driving_pressure_gradient : Vec3{};
  for (std::size_t b = 0; b < mesh.local.size(); ++b) {
    const Block& block = mesh.local[b];
    const auto [si, sj, sk] = block.layout.stride;
    const auto& [ai, aj, ak] = block.area;
    const auto& slope = drag_slope[b];
    for_cells(block.layout, [&, si = si, sj = sj, sk = sk, &ai = ai, &aj = aj,
                             &ak = ak](std::ptrdiff_t c) {
      const auto face = [&](std::size_t d, std::ptrdiff_t f, std::ptrdiff_t s) {
        const double w = block.weight[d][f];
        double jump = 0; // (slope below - slope above) . (way from centre to centre)
        for (std::size_t m = 0; m < 3; ++m)
          jump += (slope[m][f - s] - slope[m][f]) * (block.centre[m][f] - block.centre[m][f - s]);
        return on_face(p[b], block.weight[d], f, s) + w * (1 - w) * jump;
      };
      const double low_i = face(0, c, si), high_i = face(0, c + si, si);
      const double low_j = face(1, c, sj), high_j = face(1, c + sj, sj);
      const double low_k = face(2, c, sk), high_k = face(2, c + sk, sk);
      for (std::size_t m = 0; m < 3; ++m)
        grad_p[b][m][c] =
            driving[int(m)] + (high_i * ai[m][c + si] - low_i * ai[m][c] + high_j * aj[m][c + sj] -
                               low_j * aj[m][c] + high_k * ak[m][c + sk] - low_k * ak[m][c]) /
                                  block.volume[c];
    });
  }
}

Vec3 GasSolver::Impl::momentum() const {
  Vec3 total;
  for (int m = 0; m < 3; ++m)
    total[m] = sum([&](std::size_t b, std::ptrdiff_t c) {
      return fluid.density * eps_inertia[b][c] * u[b][std::size_t(m)][c] * mesh.local[b].volume[c];
    });
  return total;
}

std::string GasSolver::Impl::cell_name(std::int64_t encoded) const {
  const std::int64_t block = encoded >> 40, n = encoded & ((std::int64_t(1) << 40) - 1);
  const Index3 cells = mesh.blocks[std::size_t(block)].cells;
  return "cell (" + std::to_string(n % cells[0]) + ", " + std::to_string(n / cells[0] % cells[1]) +
         ", " + std::to_string(n / (std::int64_t(cells[0]) * cells[1])) + ") of block " +
         std::to_string(block);
}

/// Throws on all ranks, naming the first bad cell, if any velocity or coefficient is not a number.
void GasSolver::Impl::check_finite() const {
  constexpr std::int64_t none = std::numeric_limits<std::int64_t>::max();
  std::int64_t first = none;
  for (std::size_t b = 0; b < mesh.local.size() && first == none; ++b) {
    const Layout& layout = mesh.local[b].layout;
    std::int64_t n = 0;
    for (int k = 0; k < layout.cells[2]; ++k)
      for (int j = 0; j < layout.cells[1]; ++j)
        for (int i = 0; i < layout.cells[0]; ++i, ++n) {
          const std::ptrdiff_t c = layout.at(i, j, k);
          double probe = a[b][c] + share[b][c] + eps[b][c];
          for (std::size_t m = 0; m < 3; ++m)
            probe += u[b][m][c] + r[b][m][c];
          if (first == none && !std::isfinite(probe))
            first = (std::int64_t(mesh.local[b].id) << 40) + n;
        }
  }
  MPI_Allreduce(MPI_IN_PLACE, &first, 1, MPI_INT64_T, MPI_MIN, mesh.comm);
  if (first != none)
    throw NumericalError("gas: step " + std::to_string(steps + 1) + ", time " +
                         std::to_string(time) + " s: velocity or drag is not a number in " +
                         cell_name(first) +
                         "; likely causes: too large a time step (Courant number above 1), or a "
                         "particle state that is not a number");
}

void GasSolver::Impl::take_balance(double dt, const MomentumExchange* exchange,
                                   const Vec3& friction_force, const Vec3& old_momentum) {
  balance = {};
  balance.momentum = momentum();
  balance.momentum_change = (balance.momentum - old_momentum) / dt;
  balance.convection = -(ab_now * outflow + ab_old * outflow_old);
  balance.friction = friction_force;
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

  std::array<double, 23> all;
  std::size_t n = 0;
  const auto pack = [&](const Vec3& v) { all[n++] = v.x, all[n++] = v.y, all[n++] = v.z; };
  const auto unpack = [&](Vec3& v) { v = {all[n], all[n + 1], all[n + 2]}, n += 3; };
  all[n++] = balance.gas_volume_change;
  all[n++] = balance.boundary_volume_flux;
  for (const Vec3* v : {&balance.momentum, &balance.momentum_change, &balance.convection,
                        &balance.friction, &balance.pressure, &balance.driving, &balance.exchange})
    pack(*v);
  MPI_Allreduce(MPI_IN_PLACE, all.data(), int(n), MPI_DOUBLE, MPI_SUM, mesh.comm);
  n = 0;
  balance.gas_volume_change = all[n++];
  balance.boundary_volume_flux = all[n++];
  for (Vec3* v : {&balance.momentum, &balance.momentum_change, &balance.convection,
                  &balance.friction, &balance.pressure, &balance.driving, &balance.exchange})
    unpack(*v);
  balance.momentum_residual = balance.momentum_change - balance.convection - balance.friction -
                              balance.pressure - balance.driving - balance.exchange;
  for (const Vec3* v : {&balance.momentum_change, &balance.convection, &balance.friction,
                        &balance.pressure, &balance.driving, &balance.exchange})
    balance.momentum_scale += norm(*v);
  balance.momentum_scale += norm(balance.momentum) / dt;
}

/// Everything that the next step depends on.
template <class Visit> void GasSolver::Impl::visit_state(Visit&& visit) {
  double counters[] = {time,      dt_old,    double(steps), double(has_history), outflow.x,
                       outflow.y, outflow.z, outflow_old.x, outflow_old.y,       outflow_old.z};
  visit(counters, std::size(counters));
  time = counters[0], dt_old = counters[1], steps = long(counters[2]),
  has_history = counters[3] != 0;
  outflow = {counters[4], counters[5], counters[6]};
  outflow_old = {counters[7], counters[8], counters[9]};
  for (BlockFields* fields : {&eps, &eps_middle, &eps_inertia, &eps_rate, &eps_rate_old, &p})
    for (Field& field : *fields)
      visit(field.data(), field.size());
  for (BlockVectors* vectors : {&u, &grad_p, &drag_slope, &convection, &convection_old})
    for (VectorField& vector : *vectors)
      for (Field& field : vector)
        visit(field.data(), field.size());
  for (auto& block : flux)
    for (Field& field : block)
      visit(field.data(), field.size());
}

GasSolver::GasSolver(const Mesh& mesh, const GasCase& gas_case)
    : impl_(std::make_unique<Impl>(mesh, gas_case)) {
  initialise(make_fields(mesh, 1), gas_case.initial_velocity);
}

GasSolver::~GasSolver() = default;

void GasSolver::initialise(const BlockFields& void_fraction, Vec3 velocity, double time) {
  initialise(void_fraction, make_vectors(impl_->mesh, velocity), time);
}

void GasSolver::initialise(const BlockFields& void_fraction, const BlockVectors& velocity,
                           double time) {
  Impl& s = *impl_;
  s.time = time;
  s.steps = 0;
  s.has_history = false;
  s.eps = s.eps_middle = s.eps_inertia = void_fraction;
  s.eps_rate = s.eps_rate_old = make_fields(s.mesh);
  s.halo.exchange({&s.eps_middle});
  s.boundaries.fill_zero_gradient(s.eps_middle);
  s.p = make_fields(s.mesh);
  s.drag_slope = make_vectors(s.mesh);
  s.r = velocity;
  s.a = s.share = make_fields(s.mesh, 1);
  StepReport report;
  s.project(time, Drive::none, nullptr, report);
  s.p = make_fields(s.mesh); // that was a potential, not a pressure
  s.set_pressure_gradient(Drive::given);
  s.check_finite();
}

StepReport GasSolver::advance(double dt, const BlockFields& void_fraction,
                              const MomentumExchange* exchange) {
  Impl& s = *impl_;
  if (!(dt > 0))
    throw ConfigError("gas: time step " + std::to_string(dt) + " s: must be > 0");
  StepReport report;
  const double new_time = s.time + dt;
  const double ratio = s.has_history ? dt / s.dt_old : 0;
  s.ab_now = 1 + 0.5 * ratio;
  s.ab_old = -0.5 * ratio;

  const Vec3 old_momentum = s.momentum();
  s.convect();
  for (std::size_t b = 0; b < s.mesh.local.size(); ++b)
    for (std::size_t m = 0; m < 3; ++m)
      for_cells(s.mesh.local[b].layout, [&](std::ptrdiff_t c) {
        s.r[b][m][c] = s.fluid.density / dt * s.eps_inertia[b][c] * s.u[b][m][c];
      });
  s.extrapolate_inertia(dt);
  double lightest =
      s.max(-1, [&](std::size_t b, std::ptrdiff_t c) { return -s.eps_inertia[b][c]; });
  MPI_Allreduce(MPI_IN_PLACE, &lightest, 1, MPI_DOUBLE, MPI_MAX, s.mesh.comm);
  if (lightest >= 0) {
    report.history_restarted = true;
    s.eps_inertia = s.eps;
    s.ab_now = 1;
    s.ab_old = 0;
  }
  std::swap(s.eps_rate, s.eps_rate_old);
  s.eps_rate_noise = 1e-13 / dt;
  for (std::size_t b = 0; b < s.mesh.local.size(); ++b)
    for_cells(s.mesh.local[b].layout, [&](std::ptrdiff_t c) {
      s.eps_rate[b][c] = (void_fraction[b][c] - s.eps[b][c]) / dt;
      s.eps_middle[b][c] = 0.5 * (void_fraction[b][c] + s.eps[b][c]);
      s.eps[b][c] = void_fraction[b][c];
    });
  s.halo.exchange({&s.eps_middle});
  s.boundaries.fill_zero_gradient(s.eps_middle);
  s.set_conductance();

  Vec3 friction = 0.5 * s.boundary_friction();
  s.predict(dt, exchange, new_time, report);
  friction += 0.5 * s.boundary_friction();
  s.project(new_time, Drive::given, exchange, report);
  s.check_finite();
  s.take_balance(dt, exchange, friction, old_momentum);

  double largest[3] = {0, 0, 0};
  for (std::size_t b = 0; b < s.mesh.local.size(); ++b) {
    const Block& block = s.mesh.local[b];
    const auto [si, sj, sk] = block.layout.stride;
    const auto& [fi, fj, fk] = s.flux[b];
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
      return std::abs(net(c) / block.volume[c] + s.eps_rate[b][c]);
    });
    largest[1] = max_cells(block.layout, largest[1],
                           [&](std::ptrdiff_t c) { return gross(c) / block.volume[c]; });
    largest[2] = max_cells(block.layout, largest[2], [&](std::ptrdiff_t c) {
      return 0.5 * dt * gross(c) / (block.volume[c] * s.eps_middle[b][c]);
    });
  }
  MPI_Allreduce(MPI_IN_PLACE, largest, 3, MPI_DOUBLE, MPI_MAX, s.mesh.comm);
  report.continuity_residual = largest[0];
  report.continuity_scale = largest[1];
  report.courant = largest[2];
  s.time = new_time;
  s.dt_old = dt;
  s.has_history = true;
  ++s.steps;
  return report;
}

double GasSolver::time() const {
  return impl_->time;
}
long GasSolver::steps() const {
  return impl_->steps;
}
const BlockVectors& GasSolver::velocity() const {
  return impl_->u;
}
const BlockFields& GasSolver::pressure() const {
  return impl_->p;
}
const BlockVectors& GasSolver::pressure_gradient() const {
  return impl_->grad_p;
}
const BlockFields& GasSolver::void_fraction() const {
  return impl_->eps;
}
const Balance& GasSolver::balance() const {
  return impl_->balance;
}
const Mesh& GasSolver::mesh() const {
  return impl_->mesh;
}
const Fluid& GasSolver::fluid() const {
  return impl_->fluid;
}

namespace {

/// Sum over the faces of a named boundary of two terms, over all ranks.
template <class Term>
std::array<double, 2> sum_boundary(const Mesh& mesh, const Boundaries& boundaries,
                                   const std::string& name, Term&& term) {
  std::array<double, 2> sums{};
  bool known = false;
  for (const BoundaryCondition& condition : boundaries.conditions())
    known = known || condition.name == name;
  if (!known)
    throw ConfigError("the gas has no boundary named \"" + name + "\"");
  for (const BoundaryPatch& patch : boundaries.patches())
    if (boundaries.condition(patch).name == name)
      for (const BoundaryFace& face : patch.faces) {
        const std::array<double, 2> one = term(patch, face);
        sums[0] += one[0], sums[1] += one[1];
      }
  MPI_Allreduce(MPI_IN_PLACE, sums.data(), 2, MPI_DOUBLE, MPI_SUM, mesh.comm);
  return sums;
}

} // namespace

double GasSolver::boundary_pressure(const std::string& boundary) const {
  const Impl& s = *impl_;
  const auto [weighted, area] = sum_boundary(
      s.mesh, s.boundaries, boundary, [&](const BoundaryPatch& patch, const BoundaryFace& face) {
        const auto b = std::size_t(patch.block), d = std::size_t(patch.direction);
        const VectorField& area_of = s.mesh.local[b].area[d];
        const double size =
            norm({area_of[0][face.face], area_of[1][face.face], area_of[2][face.face]});
        return std::array<double, 2>{0.5 * size * (s.p[b][face.cell] + s.p[b][face.ghost]), size};
      });
  return weighted / area;
}

double GasSolver::boundary_flux(const std::string& boundary) const {
  const Impl& s = *impl_;
  return sum_boundary(
      s.mesh, s.boundaries, boundary, [&](const BoundaryPatch& patch, const BoundaryFace& face) {
        return std::array<double, 2>{
            patch.outward *
                s.flux[std::size_t(patch.block)][std::size_t(patch.direction)][face.face],
            0};
      })[0];
}

std::vector<double> GasSolver::save() const {
  std::size_t size = 0, at = 0;
  impl_->visit_state([&](const double*, std::size_t n) { size += n; });
  std::vector<double> state(size);
  impl_->visit_state([&](const double* values, std::size_t n) {
    std::copy_n(values, n, state.begin() + std::ptrdiff_t(at));
    at += n;
  });
  return state;
}

void GasSolver::load(const std::vector<double>& state) {
  std::size_t expected = 0, at = 0;
  impl_->visit_state([&](const double*, std::size_t n) { expected += n; });
  int fits = expected == state.size();
  MPI_Allreduce(MPI_IN_PLACE, &fits, 1, MPI_INT, MPI_MIN, impl_->mesh.comm);
  if (!fits)
    throw ConfigError("gas restart: " + std::to_string(state.size()) + " values saved, " +
                      std::to_string(expected) +
                      " needed: continue with the same grid, blocks and number of ranks");
  impl_->visit_state([&](double* values, std::size_t n) {
    std::copy_n(state.begin() + std::ptrdiff_t(at), n, values);
    at += n;
  });
}

} // namespace granflux::cfd
