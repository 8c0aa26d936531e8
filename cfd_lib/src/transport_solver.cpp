// SPDX-FileCopyrightText: 2026 The GranFlux developers
// SPDX-License-Identifier: BSD-3-Clause
#include <granflux/cfd/transport_solver.hpp>

#include <algorithm>
#include <cmath>
#include <string>

#include <granflux/cfd/error.hpp>
#include <granflux/cfd/sweep.hpp>

namespace granflux::cfd {

TransportSolver::TransportSolver(const Mesh& mesh, const Halo& halo, const Boundaries& boundaries)
    : mesh_(mesh), halo_(halo), boundaries_(boundaries), outflow_(make_fields(mesh)),
      diagonal_(make_fields(mesh)), shadow_(make_fields(mesh)), direction_(make_fields(mesh)),
      scaled_(make_fields(mesh)), image_(make_fields(mesh)), image_of_scaled_(make_fields(mesh)) {
  for (const Block& block : mesh.local)
    carried_.push_back({Field(block.layout), Field(block.layout), Field(block.layout)});
}

template <class Term> double TransportSolver::sum(Term&& term) const {
  double total = 0;
  for (std::size_t b = 0; b < mesh_.local.size(); ++b)
    total += sum_cells(mesh_.local[b].layout, [&](std::ptrdiff_t c) { return term(b, c); });
  MPI_Allreduce(MPI_IN_PLACE, &total, 1, MPI_DOUBLE, MPI_SUM, mesh_.comm);
  return total;
}

void TransportSolver::set_operator(const BlockFields& inertia, const FaceConductance& conductance,
                                   const std::vector<std::array<Field, 3>>& flux, double factor) {
  inertia_ = &inertia;
  conductance_ = &conductance;
  for (std::size_t b = 0; b < mesh_.local.size(); ++b) {
    outflow_[b].fill(0);
    for (std::size_t d = 0; d < 3; ++d)
      for_faces(mesh_.local[b].layout, int(d),
                [&](std::ptrdiff_t f) { carried_[b][d][f] = 0.5 * factor * flux[b][d][f]; });
  }
  for (const BoundaryPatch& patch : boundaries_.patches()) {
    const auto b = std::size_t(patch.block), d = std::size_t(patch.direction);
    for (const BoundaryFace& face : patch.faces) {
      outflow_[b][face.cell] += std::max(0.0, patch.outward * carried_[b][d][face.face]);
      carried_[b][d][face.face] = 0;
    }
  }
  for (std::size_t b = 0; b < mesh_.local.size(); ++b) {
    const Layout& layout = mesh_.local[b].layout;
    for_cells(layout, [&](std::ptrdiff_t c) {
      double faces = 0, leaving = 0;
      for (std::size_t d = 0; d < 3; ++d) {
        const std::ptrdiff_t s = layout.stride[d];
        faces += conductance[b][d][c] + conductance[b][d][c + s];
        leaving += std::max(0.0, -carried_[b][d][c]) + std::max(0.0, carried_[b][d][c + s]);
      }
      diagonal_[b][c] = inertia[b][c] + outflow_[b][c] + leaving + 0.5 * faces;
    });
  }
}

void TransportSolver::multiply(const Unknown& unknown, BlockFields& q, BlockFields& image) {
  halo_.exchange({&q});
  for (const BoundaryPatch& patch : boundaries_.patches()) {
    Field& x = q[std::size_t(patch.block)];
    for (const BoundaryFace& face : patch.faces)
      x[face.ghost] = unknown.ghost_factor(patch, face) * x[face.cell];
  }
  for (std::size_t b = 0; b < mesh_.local.size(); ++b) {
    const Layout& layout = mesh_.local[b].layout;
    const auto [si, sj, sk] = layout.stride;
    const auto& [fi, fj, fk] = carried_[b];
    const Field& x = q[b];
    diffusion(layout, (*conductance_)[b], x, image[b]);
    const auto upwind = [&](const Field& f, std::ptrdiff_t c, std::ptrdiff_t s) {
      return std::max(f[c], 0.0) * x[c - s] + std::min(f[c], 0.0) * x[c];
    };
    for_cells(layout,
              [&, si = si, sj = sj, sk = sk, &fi = fi, &fj = fj, &fk = fk](std::ptrdiff_t c) {
                image[b][c] = ((*inertia_)[b][c] + outflow_[b][c]) * x[c] - 0.5 * image[b][c] +
                              upwind(fi, c + si, si) - upwind(fi, c, si) + upwind(fj, c + sj, sj) -
                              upwind(fj, c, sj) + upwind(fk, c + sk, sk) - upwind(fk, c, sk);
              });
  }
}

int TransportSolver::solve(const Unknown& unknown, BlockFields& defect, double reduction,
                           double enough) {
  constexpr int most_iterations = 1000;
  const auto each = [&](auto&& body) {
    for (std::size_t b = 0; b < mesh_.local.size(); ++b)
      for_cells(mesh_.local[b].layout, [&](std::ptrdiff_t c) { body(b, c); });
  };
  const auto product = [&](const BlockFields& x, const BlockFields& y) {
    return sum([&](std::size_t b, std::ptrdiff_t c) { return x[b][c] * y[b][c]; });
  };
  double size = std::sqrt(product(defect, defect));
  const double target = std::max(enough, reduction * size);
  if (size <= enough)
    return 0;
  shadow_ = defect;
  for (BlockFields* fields : {&direction_, &image_})
    for (Field& field : *fields)
      field.fill(0);
  double rho = 1, alpha = 1, omega = 1;
  for (int iteration = 1; iteration <= most_iterations; ++iteration) {
    const double rho_new = product(shadow_, defect);
    const double beta = rho_new / rho * (alpha / omega);
    rho = rho_new;
    each([&](std::size_t b, std::ptrdiff_t c) {
      direction_[b][c] = defect[b][c] + beta * (direction_[b][c] - omega * image_[b][c]);
      scaled_[b][c] = direction_[b][c] / diagonal_[b][c];
    });
    multiply(unknown, scaled_, image_);
    alpha = rho / product(shadow_, image_);
    each([&](std::size_t b, std::ptrdiff_t c) {
      unknown.at(b)[c] += alpha * scaled_[b][c];
      defect[b][c] -= alpha * image_[b][c];
    });
    size = std::sqrt(product(defect, defect));
    if (size <= target)
      return iteration;
    each([&](std::size_t b, std::ptrdiff_t c) { scaled_[b][c] = defect[b][c] / diagonal_[b][c]; });
    multiply(unknown, scaled_, image_of_scaled_);
    omega = product(image_of_scaled_, defect) / product(image_of_scaled_, image_of_scaled_);
    each([&](std::size_t b, std::ptrdiff_t c) {
      unknown.at(b)[c] += omega * scaled_[b][c];
      defect[b][c] -= omega * image_of_scaled_[b][c];
    });
    size = std::sqrt(product(defect, defect));
    if (size <= target)
      return iteration;
    if (!std::isfinite(size))
      break;
  }
  throw NumericalError(unknown.name + ": implicit convection and diffusion did not converge; use a "
                                      "smaller time step");
}

} // namespace granflux::cfd
