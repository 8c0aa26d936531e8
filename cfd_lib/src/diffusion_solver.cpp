// SPDX-FileCopyrightText: 2026 The GranFlux developers
// SPDX-License-Identifier: BSD-3-Clause
#include <granflux/cfd/diffusion_solver.hpp>

#include <cmath>
#include <string>

#include <granflux/cfd/error.hpp>
#include <granflux/cfd/sweep.hpp>

namespace granflux::cfd {

void diffusion(const Layout& layout, const std::array<Field, 3>& conductance, const Field& q,
               Field& out) {
  const auto [si, sj, sk] = layout.stride;
  const Field &gi = conductance[0], &gj = conductance[1], &gk = conductance[2];
  for_cells(layout, [&, si = si, sj = sj, sk = sk](std::ptrdiff_t c) {
    out[c] = gi[c + si] * (q[c + si] - q[c]) - gi[c] * (q[c] - q[c - si]) +
             gj[c + sj] * (q[c + sj] - q[c]) - gj[c] * (q[c] - q[c - sj]) +
             gk[c + sk] * (q[c + sk] - q[c]) - gk[c] * (q[c] - q[c - sk]);
  });
}

DiffusionSolver::DiffusionSolver(const Mesh& mesh, const Halo& halo)
    : mesh_(mesh), halo_(halo), direction_(make_fields(mesh)), image_(make_fields(mesh)),
      diagonal_(make_fields(mesh)) {}

int DiffusionSolver::solve(const Unknown& unknown, const BlockFields& inertia,
                           const FaceConductance& conductance, BlockFields& defect, double scale,
                           double tolerance) {
  constexpr int most_iterations = 1000;
  const auto sum = [&](auto&& term) {
    double total = 0;
    for (std::size_t b = 0; b < mesh_.local.size(); ++b)
      total += sum_cells(mesh_.local[b].layout, [&](std::ptrdiff_t c) { return term(b, c); });
    MPI_Allreduce(MPI_IN_PLACE, &total, 1, MPI_DOUBLE, MPI_SUM, mesh_.comm);
    return total;
  };
  const double enough = tolerance * scale;
  double size =
      std::sqrt(sum([&](std::size_t b, std::ptrdiff_t c) { return defect[b][c] * defect[b][c]; }));
  if (size <= enough)
    return 0;

  for (std::size_t b = 0; b < mesh_.local.size(); ++b) {
    const Layout& layout = mesh_.local[b].layout;
    const auto& g = conductance[b];
    for_cells(layout, [&](std::ptrdiff_t c) {
      double faces = 0;
      for (std::size_t d = 0; d < 3; ++d)
        faces += g[d][c] + g[d][c + layout.stride[d]];
      diagonal_[b][c] = inertia[b][c] + 0.5 * faces;
      direction_[b][c] = defect[b][c] / diagonal_[b][c];
    });
  }
  double rz = sum([&](std::size_t b, std::ptrdiff_t c) { return defect[b][c] * direction_[b][c]; });
  for (int iteration = 1; iteration <= most_iterations; ++iteration) {
    halo_.exchange({&direction_});
    unknown.fill_ghosts(direction_);
    for (std::size_t b = 0; b < mesh_.local.size(); ++b) {
      diffusion(mesh_.local[b].layout, conductance[b], direction_[b], image_[b]);
      for_cells(mesh_.local[b].layout, [&](std::ptrdiff_t c) {
        image_[b][c] = inertia[b][c] * direction_[b][c] - 0.5 * image_[b][c];
      });
    }
    const double curvature =
        sum([&](std::size_t b, std::ptrdiff_t c) { return direction_[b][c] * image_[b][c]; });
    const double step = rz / curvature;
    for (std::size_t b = 0; b < mesh_.local.size(); ++b) {
      Field& q = unknown.at(b);
      for_cells(mesh_.local[b].layout, [&](std::ptrdiff_t c) {
        q[c] += step * direction_[b][c];
        defect[b][c] -= step * image_[b][c];
      });
    }
    size = std::sqrt(
        sum([&](std::size_t b, std::ptrdiff_t c) { return defect[b][c] * defect[b][c]; }));
    if (size <= enough)
      return iteration;
    const double rz_new = sum([&](std::size_t b, std::ptrdiff_t c) {
      return defect[b][c] * defect[b][c] / diagonal_[b][c];
    });
    const double keep = rz_new / rz;
    rz = rz_new;
    for (std::size_t b = 0; b < mesh_.local.size(); ++b)
      for_cells(mesh_.local[b].layout, [&](std::ptrdiff_t c) {
        direction_[b][c] = defect[b][c] / diagonal_[b][c] + keep * direction_[b][c];
      });
  }
  throw NumericalError(unknown.name + " did not converge in " + std::to_string(most_iterations) +
                       " iterations: defect " + std::to_string(size / scale) + " of its scale, " +
                       std::to_string(tolerance) + " wanted; use a smaller time step");
}

} // namespace granflux::cfd
