// SPDX-FileCopyrightText: 2026 The GranFlux developers
// SPDX-License-Identifier: BSD-3-Clause
#include <granflux/cfd/diffusion_solver.hpp>

#include <algorithm>
#include <cmath>

#include <granflux/cfd/error.hpp>
#include <granflux/cfd/row_sweep.hpp>

namespace granflux::cfd {

namespace {

/// diffusion(q) of one block.
struct Diffusion {
  Diffusion(const Layout& layout, const std::array<Field, 3>& conductance)
      : gi(conductance[0].data()), gj(conductance[1].data()), gk(conductance[2].data()),
        sj(layout.stride[1]), sk(layout.stride[2]) {}
  double operator()(const double* q, std::ptrdiff_t c) const {
    const double here = q[c];
    return gi[c + 1] * (q[c + 1] - here) - gi[c] * (here - q[c - 1]) +
           gj[c + sj] * (q[c + sj] - here) - gj[c] * (here - q[c - sj]) +
           gk[c + sk] * (q[c + sk] - here) - gk[c] * (here - q[c - sk]);
  }
  [[nodiscard]] double faces(std::ptrdiff_t c) const {
    return gi[c] + gi[c + 1] + gj[c] + gj[c + sj] + gk[c] + gk[c + sk];
  }
  const double *gi, *gj, *gk;
  std::ptrdiff_t sj, sk;
};

} // namespace

void diffusion(const Layout& layout, const std::array<Field, 3>& conductance, const Field& q,
               Field& out) {
  const Diffusion spread(layout, conductance);
  for_rows(layout, [&, from = q.data(), to = out.data(), n = layout.cells[0]](std::ptrdiff_t row,
                                                                              int, int) {
#pragma omp simd
    for (std::ptrdiff_t c = row; c < row + n; ++c)
      to[c] = spread(from, c);
  });
}

DiffusionSolver::DiffusionSolver(const Mesh& mesh, const Halo& halo)
    : mesh_(mesh), halo_(halo), correction_(make_fields(mesh)), before_(make_fields(mesh)),
      inverse_diagonal_(make_fields(mesh)) {}

void DiffusionSolver::set_operator(const BlockFields& inertia, const FaceConductance& conductance) {
  inertia_ = &inertia;
  conductance_ = &conductance;
  half_width_ = 0;
  for (std::size_t b = 0; b < mesh_.local.size(); ++b) {
    const Layout& layout = mesh_.local[b].layout;
    const Diffusion spread(layout, conductance[b]);
    const double* mass = inertia[b].data();
    double* inverse = inverse_diagonal_[b].data();
    half_width_ = std::max(half_width_, max_cells(layout, 0, [=](std::ptrdiff_t c) {
                             const double half = 0.5 * spread.faces(c);
                             inverse[c] = 1 / (mass[c] + half);
                             return half * inverse[c];
                           }));
  }
  MPI_Allreduce(MPI_IN_PLACE, &half_width_, 1, MPI_DOUBLE, MPI_MAX, mesh_.comm);
}

/// correction + keep (correction - the one before) + gain (defect - A correction) / diagonal, which
/// becomes the correction.
void DiffusionSolver::step(const Unknown& unknown, const BlockFields& defect, double keep,
                           double gain) {
  halo_.exchange({&correction_});
  unknown.fill_ghosts(correction_);
  for (std::size_t b = 0; b < mesh_.local.size(); ++b) {
    const Layout& layout = mesh_.local[b].layout;
    const Diffusion spread(layout, (*conductance_)[b]);
    for_rows(layout, [=, x = correction_[b].data(), next = before_[b].data(), d = defect[b].data(),
                      mass = (*inertia_)[b].data(), inverse = inverse_diagonal_[b].data(),
                      n = layout.cells[0]](std::ptrdiff_t row, int, int) {
#pragma omp simd
      for (std::ptrdiff_t c = row; c < row + n; ++c)
        next[c] = x[c] + keep * (x[c] - next[c]) +
                  gain * inverse[c] * (d[c] - mass[c] * x[c] + 0.5 * spread(x, c));
    });
  }
  std::swap(correction_, before_);
}

/// Adds the correction to the unknown and takes what it did off the defect; returns what is left.
double DiffusionSolver::take_off(const Unknown& unknown, BlockFields& defect) {
  halo_.exchange({&correction_});
  unknown.fill_ghosts(correction_);
  double left = 0;
  for (std::size_t b = 0; b < mesh_.local.size(); ++b) {
    const Layout& layout = mesh_.local[b].layout;
    const Diffusion spread(layout, (*conductance_)[b]);
    const double *x = correction_[b].data(), *mass = (*inertia_)[b].data();
    double *q = unknown.at(b).data(), *d = defect[b].data();
    left += sum_rows<1>(layout, room_, [=, n = layout.cells[0]](std::ptrdiff_t row, int, int) {
      double squares = 0;
#pragma omp simd reduction(+ : squares)
      for (std::ptrdiff_t c = row; c < row + n; ++c) {
        q[c] += x[c];
        d[c] -= mass[c] * x[c] - 0.5 * spread(x, c);
        squares += d[c] * d[c];
      }
      return std::array<double, 1>{squares};
    })[0];
  }
  MPI_Allreduce(MPI_IN_PLACE, &left, 1, MPI_DOUBLE, MPI_SUM, mesh_.comm);
  return std::sqrt(left);
}

int DiffusionSolver::solve(const Unknown& unknown, BlockFields& defect, double enough) {
  constexpr int most_iterations = 5000;
  double size = 0;
  for (std::size_t b = 0; b < mesh_.local.size(); ++b)
    size += sum_cells(mesh_.local[b].layout,
                      [&](std::ptrdiff_t c) { return defect[b][c] * defect[b][c]; });
  MPI_Allreduce(MPI_IN_PLACE, &size, 1, MPI_DOUBLE, MPI_SUM, mesh_.comm);
  size = std::sqrt(size);

  const double s = half_width_, factor = s / (1 + std::sqrt(1 - s * s)); // of one iteration
  int iterations = 0;
  while (size > enough) {
    if (iterations > most_iterations || !std::isfinite(size))
      throw NumericalError(unknown.name + " did not converge in " + std::to_string(iterations) +
                           " iterations: defect " + std::to_string(size / enough) +
                           " times what was wanted; use a smaller time step");
    const double wanted = 0.5 * enough / size;
    const int count = s > 0 ? std::max(1, int(std::ceil(std::log(wanted) / std::log(factor)))) : 1;
    for (std::size_t b = 0; b < mesh_.local.size(); ++b) { // from zero: no neighbours
      const Layout& layout = mesh_.local[b].layout;
      for_rows(layout, [=, x = correction_[b].data(), zero = before_[b].data(),
                        d = defect[b].data(), inverse = inverse_diagonal_[b].data(),
                        n = layout.cells[0]](std::ptrdiff_t row, int, int) {
#pragma omp simd
        for (std::ptrdiff_t c = row; c < row + n; ++c) {
          x[c] = inverse[c] * d[c];
          zero[c] = 0;
        }
      });
    }
    double rho = s; // Saad, Iterative Methods for Sparse Linear Systems, 2nd ed., algorithm 12.1
    for (int k = 1; k < count; ++k) {
      const double rho_new = 1 / (2 / s - rho);
      step(unknown, defect, rho_new * rho, 2 * rho_new / s);
      rho = rho_new;
    }
    iterations += count;
    size = take_off(unknown, defect);
  }
  return iterations;
}

} // namespace granflux::cfd
