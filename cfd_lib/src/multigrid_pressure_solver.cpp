// SPDX-FileCopyrightText: 2026 The GranFlux developers
// SPDX-License-Identifier: BSD-3-Clause
#include <granflux/cfd/pressure_solver.hpp>

#include <cmath>
#include <limits>

#include <granflux/cfd/error.hpp>
#include <granflux/cfd/multigrid.hpp>
#include <granflux/cfd/row_sweep.hpp>

namespace granflux::cfd {

namespace {

constexpr int most_iterations = 500;

class MultigridPressureSolver final : public PressureSolver {
public:
  MultigridPressureSolver(const Mesh& mesh, bool singular, double tolerance)
      : mesh_(mesh), singular_(singular), tolerance_(tolerance), multigrid_(mesh, singular),
        residual_(make_fields(mesh)), direction_(make_fields(mesh)), image_(make_fields(mesh)) {
    for (const BlockInfo& info : mesh.blocks)
      cells_ += double(info.cells[0]) * info.cells[1] * info.cells[2];
  }

  /// Conjugate gradients for the negated, positive definite system.
  PressureReport solve(const PressureSystem& system, BlockFields& p) override {
    multigrid_.setup(system);
    double size = start(system, p);
    if (singular_) // rounding has put a part there that no pressure can balance
      size = take_mean_off(residual_);
    if (!std::isfinite(size))
      throw NumericalError("pressure equation: the right-hand side is not a number; likely "
                           "causes: too large a time step (Courant number above 1), or an "
                           "exchange that is not a number");
    // What the differences in rhs have lost to rounding cannot be solved for.
    constexpr double rounding = 4 * std::numeric_limits<double>::epsilon();
    const double enough = std::max(tolerance_ * size, rounding * system.scale);
    double left = size;
    double rz = 0;
    PressureReport report;
    while (left > enough) {
      if (++report.iterations > most_iterations || !std::isfinite(left))
        throw NumericalError("pressure equation: no solution in " +
                             std::to_string(most_iterations) + " iterations: residual " +
                             std::to_string(left / size) + " of the right-hand side, " +
                             std::to_string(tolerance_) + " wanted");
      const BlockFields& z = multigrid_.apply(residual_);
      const double rz_new = dot(residual_, z);
      const double keep = report.iterations == 1 ? 0 : rz_new / rz;
      rz = rz_new;
      for_blocks([&](std::size_t b, const Layout& layout) {
        const double* from = z[b].data();
        double* to = direction_[b].data();
        for_rows(layout, [=, n = layout.cells[0]](std::ptrdiff_t row, int, int) {
#pragma omp simd
          for (std::ptrdiff_t c = row; c < row + n; ++c)
            to[c] = from[c] + keep * to[c];
        });
      });
      left = advance(rz / multigrid_.multiply(direction_, image_), p);
    }
    report.residual = size > 0 ? left / size : 0;
    if (singular_)
      take_mean_off(p);
    return report;
  }

private:
  template <class Body> void for_blocks(Body&& body) const {
    for (std::size_t b = 0; b < mesh_.local.size(); ++b)
      body(b, mesh_.local[b].layout);
  }

  /// Sum over all ranks of what row(b, first position, cells) returns.
  template <class Row> double sum(Row&& row_sum) {
    double total = 0;
    for_blocks([&](std::size_t b, const Layout& layout) {
      total += sum_rows(layout, row_sums_,
                        [&](std::ptrdiff_t row) { return row_sum(b, row, layout.cells[0]); });
    });
    MPI_Allreduce(MPI_IN_PLACE, &total, 1, MPI_DOUBLE, MPI_SUM, mesh_.comm);
    return total;
  }

  double dot(const BlockFields& one, const BlockFields& two) {
    return sum([&](std::size_t b, std::ptrdiff_t row, int n) {
      const double *v = one[b].data(), *w = two[b].data();
      double total = 0;
#pragma omp simd reduction(+ : total)
      for (std::ptrdiff_t c = row; c < row + n; ++c)
        total += v[c] * w[c];
      return total;
    });
  }

  /// p = 0 and the residual of that; returns its norm.
  double start(const PressureSystem& system, BlockFields& p) {
    return std::sqrt(sum([&](std::size_t b, std::ptrdiff_t row, int n) {
      const double* rhs = system.rhs[b].data();
      double *r = residual_[b].data(), *to = p[b].data();
      double total = 0;
#pragma omp simd reduction(+ : total)
      for (std::ptrdiff_t c = row; c < row + n; ++c) {
        r[c] = -rhs[c];
        to[c] = 0;
        total += r[c] * r[c];
      }
      return total;
    }));
  }

  /// Moves p by `length` along the direction; returns the norm of the residual.
  double advance(double length, BlockFields& p) {
    return std::sqrt(sum([&](std::size_t b, std::ptrdiff_t row, int n) {
      const double *direction = direction_[b].data(), *image = image_[b].data();
      double *r = residual_[b].data(), *to = p[b].data();
      double total = 0;
#pragma omp simd reduction(+ : total)
      for (std::ptrdiff_t c = row; c < row + n; ++c) {
        to[c] += length * direction[c];
        r[c] -= length * image[c];
        total += r[c] * r[c];
      }
      return total;
    }));
  }

  /// Returns the norm of what is left.
  double take_mean_off(BlockFields& q) {
    const double total = sum([&](std::size_t b, std::ptrdiff_t row, int n) {
      const double* v = q[b].data();
      double row_total = 0;
#pragma omp simd reduction(+ : row_total)
      for (std::ptrdiff_t c = row; c < row + n; ++c)
        row_total += v[c];
      return row_total;
    });
    return std::sqrt(sum([&, mean = total / cells_](std::size_t b, std::ptrdiff_t row, int n) {
      double* v = q[b].data();
      double squares = 0;
#pragma omp simd reduction(+ : squares)
      for (std::ptrdiff_t c = row; c < row + n; ++c) {
        v[c] -= mean;
        squares += v[c] * v[c];
      }
      return squares;
    }));
  }

  const Mesh& mesh_;
  bool singular_;
  double tolerance_;
  double cells_ = 0; ///< of all ranks
  Multigrid multigrid_;
  BlockFields residual_, direction_, image_;
  std::vector<double> row_sums_;
};

} // namespace

std::unique_ptr<PressureSolver> make_multigrid_pressure_solver(const Mesh& mesh, bool singular,
                                                               double tolerance) {
  return std::make_unique<MultigridPressureSolver>(mesh, singular, tolerance);
}

} // namespace granflux::cfd
