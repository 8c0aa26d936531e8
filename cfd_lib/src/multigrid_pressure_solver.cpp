// SPDX-FileCopyrightText: 2026 The GranFlux developers
// SPDX-License-Identifier: BSD-3-Clause
#include <granflux/cfd/pressure_solver.hpp>

#include <cmath>
#include <limits>
#include <omp.h>

#include <granflux/cfd/coarsening.hpp>
#include <granflux/cfd/error.hpp>
#include <granflux/cfd/halo.hpp>
#include <granflux/cfd/multigrid.hpp>
#include <granflux/cfd/row_sweep.hpp>

namespace granflux::cfd {

namespace {

constexpr int most_iterations = 500;

/// Powers of 2 round nothing: sizes are brought near 1 with them, for single precision and lest
/// squares leave the range of double precision.
double scale_to_one(double size) {
  return std::ldexp(1, -std::ilogb(size));
}

/// Conjugate gradients in double precision for the negated, positive definite system, multiplied
/// by a power of 2: s A p = -rhs.
class MultigridPressureSolver final : public PressureSolver {
public:
  MultigridPressureSolver(const Mesh& mesh, bool singular, double tolerance)
      : mesh_(mesh), singular_(singular), tolerance_(tolerance), multigrid_(mesh, singular),
        halo_(mesh, 1), residual_(make_fields(mesh)), direction_(make_fields(mesh)),
        image_(make_fields(mesh)), scales_(mesh.local.size()) {
    for (const BlockInfo& info : mesh.blocks)
      cells_ += double(info.cells[0]) * info.cells[1] * info.cells[2];
  }

  PressureReport solve(const PressureSystem& system, BlockFields& p, FirstGuess guess) override {
    system_ = &system;
    multigrid_.setup(system);
    for (std::size_t b = 0; b < mesh_.local.size(); ++b)
      for (int d = 0; d < 3; ++d)
        scales_[b][std::size_t(d)] =
            closed_on_itself(mesh_, mesh_.local[b].id, d) ? 0 : multigrid_.scale();
    const double size = take_rhs();
    if (!std::isfinite(size))
      throw NumericalError("pressure equation: the right-hand side is not a number; likely "
                           "causes: too large a time step (Courant number above 1), or an "
                           "exchange that is not a number");
    // What the differences in rhs have lost to rounding cannot be solved for.
    constexpr double rounding = 4 * std::numeric_limits<double>::epsilon();
    const double enough = std::max(tolerance_ * size, rounding * system.scale * rhs_scale_);
    const double unit = multigrid_.scale() / rhs_scale_; // of p
    double left = guess == FirstGuess::given ? start_from(p, unit) : start_from_zero(p, size);
    double rz = 0;
    PressureReport report;
    while (left > enough) {
      if (++report.iterations > most_iterations || !std::isfinite(left))
        throw NumericalError("pressure equation: no solution in " +
                             std::to_string(most_iterations) + " iterations: residual " +
                             std::to_string(left / size) + " of the right-hand side, " +
                             std::to_string(tolerance_) + " wanted");
      const double rz_new = multigrid_.apply() / (residual_scale_ * residual_scale_);
      const double keep = report.iterations == 1 ? 0 : rz_new / rz;
      rz = rz_new;
      left = advance(rz / turn(keep), unit, scale_to_one(left), p);
    }
    report.residual = size > 0 ? left / size : 0;
    if (singular_)
      take_mean_off(p);
    return report;
  }

private:
  /// Sums over all ranks of what row(b, first position, j, k) returns.
  template <std::size_t count, class Row> std::array<double, count> sums(Row&& row_sums) {
    std::array<double, count> total{};
    for (std::size_t b = 0; b < mesh_.local.size(); ++b) {
      const auto of_block =
          sum_rows<count>(mesh_.local[b].layout, room_,
                          [&](std::ptrdiff_t row, int j, int k) { return row_sums(b, row, j, k); });
      for (std::size_t n = 0; n < count; ++n)
        total[n] += of_block[n];
    }
    MPI_Allreduce(MPI_IN_PLACE, total.data(), int(count), MPI_DOUBLE, MPI_SUM, mesh_.comm);
    return total;
  }

  /// body(i) for the cells of a row, with the sum of what it returns.
  template <class Term> static double sum_row(std::ptrdiff_t n, Term&& term) {
    double total = 0;
#pragma omp simd reduction(+ : total)
    for (std::ptrdiff_t i = 0; i < n; ++i)
      total += term(i);
    return total;
  }

  [[nodiscard]] std::ptrdiff_t cells_of_row(std::size_t b) const {
    return mesh_.local[b].layout.cells[0];
  }
  float* rounded_residual(std::size_t b, int j, int k) {
    return multigrid_.residual(b) + multigrid_.layout(b).at(0, j, k);
  }

  /// The residual of p = 0, but for its scale; returns its norm. Where there is no given pressure
  /// its mean is rounding that no pressure can balance, and is taken off.
  double take_rhs() {
    double size = negate_rhs();
    if (size > 0 && std::isfinite(size) && std::abs(std::ilogb(size)) < 40)
      return size;
    // Far from 1, or from what squares can hold: scaled by its largest number.
    double most = 0;
    for (std::size_t b = 0; b < mesh_.local.size(); ++b)
      most = std::max(most, max_cells(mesh_.local[b].layout, 0, [&](std::ptrdiff_t c) {
                        return std::abs(system_->rhs[b][c]);
                      }));
    MPI_Allreduce(MPI_IN_PLACE, &most, 1, MPI_DOUBLE, MPI_MAX, mesh_.comm);
    if (!(most > 0) || !std::isfinite(most))
      return size;
    rhs_scale_ = scale_to_one(most);
    return negate_rhs();
  }

  double negate_rhs() {
    const auto [squares, sum] =
        sums<2>([&](std::size_t b, std::ptrdiff_t row, int, int) -> std::array<double, 2> {
          const double* rhs = system_->rhs[b].data() + row;
          double* r = residual_[b].data() + row;
          double row_sum = 0;
          const double factor = -rhs_scale_;
          double row_squares = 0;
#pragma omp simd reduction(+ : row_squares, row_sum)
          for (std::ptrdiff_t i = 0; i < cells_of_row(b); ++i) {
            r[i] = factor * rhs[i];
            row_squares += r[i] * r[i];
            row_sum += r[i];
          }
          return {row_squares, row_sum};
        });
    return singular_ ? take_off(residual_, sum / cells_) : std::sqrt(squares);
  }

  double start_from_zero(BlockFields& p, double size) {
    const double rounded = size > 0 && std::isfinite(size) ? scale_to_one(size) : 1;
    residual_scale_ = rounded;
    for (std::size_t b = 0; b < mesh_.local.size(); ++b)
      for_rows(mesh_.local[b].layout, [&](std::ptrdiff_t row, int j, int k) {
        const double* r = residual_[b].data() + row;
        double* to = p[b].data() + row;
        float* r_rounded = rounded_residual(b, j, k);
#pragma omp simd
        for (std::ptrdiff_t i = 0; i < cells_of_row(b); ++i) {
          to[i] = 0;
          r_rounded[i] = float(rounded * r[i]);
        }
      });
    return size;
  }

  /// Takes s A p off the residual; returns the norm of what is left.
  double start_from(const BlockFields& p, double unit) {
    for (std::size_t b = 0; b < mesh_.local.size(); ++b)
      for_rows(mesh_.local[b].layout, [&](std::ptrdiff_t row, int, int) {
        const double* guess = p[b].data() + row;
        double* d = direction_[b].data() + row;
        for (std::ptrdiff_t i = 0; i < cells_of_row(b); ++i)
          d[i] = guess[i] / unit;
      });
    halo_.exchange({&direction_});
    for (std::size_t b = 0; b < mesh_.local.size(); ++b)
      for_rows(mesh_.local[b].layout, [&](std::ptrdiff_t row, int, int) { image_row(b, row); });
    const auto [squares] = sums<1>([&](std::size_t b, std::ptrdiff_t row, int, int) {
      const double* image = image_[b].data() + row;
      double* r = residual_[b].data() + row;
      return std::array{sum_row(cells_of_row(b), [=](std::ptrdiff_t i) {
        r[i] -= image[i];
        return r[i] * r[i];
      })};
    });
    const double left = std::sqrt(squares);
    residual_scale_ = left > 0 && std::isfinite(left) ? scale_to_one(left) : 1;
    for (std::size_t b = 0; b < mesh_.local.size(); ++b)
      for_rows(mesh_.local[b].layout, [&](std::ptrdiff_t row, int j, int k) {
        const double* r = residual_[b].data() + row;
        float* rounded = rounded_residual(b, j, k);
        for (std::ptrdiff_t i = 0; i < cells_of_row(b); ++i)
          rounded[i] = float(residual_scale_ * r[i]);
      });
    return left;
  }

  /// image = s A direction for one row; returns the row's part of direction . image.
  double image_row(std::size_t b, std::ptrdiff_t row) {
    const std::ptrdiff_t sj = mesh_.local[b].layout.stride[1], sk = mesh_.local[b].layout.stride[2];
    const double* d = direction_[b].data() + row;
    const auto& c = system_->coefficient[b];
    const double *ci = c[0].data() + row, *cj = c[1].data() + row, *ck = c[2].data() + row;
    double* image = image_[b].data() + row;
    const auto [scale_i, scale_j, scale_k] = scales_[b];
    return sum_row(cells_of_row(b), [=, scale_i = scale_i, scale_j = scale_j,
                                     scale_k = scale_k](std::ptrdiff_t i) {
      const double here = d[i];
      image[i] = scale_i * (ci[i] * (here - d[i - 1]) + ci[i + 1] * (here - d[i + 1])) +
                 scale_j * (cj[i] * (here - d[i - sj]) + cj[i + sj] * (here - d[i + sj])) +
                 scale_k * (ck[i] * (here - d[i - sk]) + ck[i + sk] * (here - d[i + sk]));
      return here * image[i];
    });
  }

  /// direction = correction + keep direction and its image, in one sweep; returns their product
  /// over all ranks. Ghosts of the direction follow from those of the correction.
  double turn(double keep) {
    double total = 0;
    for (std::size_t b = 0; b < mesh_.local.size(); ++b) {
      const Layout& layout = mesh_.local[b].layout;
      const LevelLayout& from = multigrid_.layout(b);
      const auto [ni, nj, nk] = layout.cells;
      const auto planes = std::size_t(nk), rows = std::size_t(nj);
      room_.resize(std::max(room_.size(), planes * rows));
      const double unit = 1 / residual_scale_;
      const auto turn_plane = [&, ni = ni, nj = nj](int k) {
        for (int j = -1; j <= nj; ++j) {
          const float* z = multigrid_.correction(b) + from.at(0, j, k);
          double* d = direction_[b].data() + layout.at(0, j, k);
          if (keep == 0)
            for (int i = -1; i <= ni; ++i)
              d[i] = unit * z[i];
          else
#pragma omp simd
            for (int i = -1; i <= ni; ++i)
              d[i] = unit * z[i] + keep * d[i];
        }
      };
      in_team(worth_a_team(layout), [&, nj = nj, nk = nk] {
        const int threads = omp_get_num_threads(), thread = omp_get_thread_num();
        const int begin = int(long(nk) * thread / threads),
                  end = int(long(nk) * (thread + 1) / threads);
        // First the planes that other threads need.
        if (begin < end) {
          turn_plane(begin);
          if (end - 1 > begin)
            turn_plane(end - 1);
          if (begin == 0)
            turn_plane(-1);
          if (end == nk)
            turn_plane(nk);
        }
#pragma omp barrier
        for (int k = begin; k < end; ++k) {
          if (k + 1 < end - 1)
            turn_plane(k + 1);
          for (int j = 0; j < nj; ++j)
            room_[std::size_t(j) + rows * std::size_t(k)] = image_row(b, layout.at(0, j, k));
        }
      });
      for (std::size_t r = 0; r < planes * rows; ++r)
        total += room_[r];
    }
    MPI_Allreduce(MPI_IN_PLACE, &total, 1, MPI_DOUBLE, MPI_SUM, mesh_.comm);
    return total;
  }

  /// Moves p by `length` along the direction; returns the norm of the residual and rounds it,
  /// multiplied by `rounded_scale`, for multigrid.
  double advance(double length, double unit, double rounded_scale, BlockFields& p) {
    residual_scale_ = rounded_scale;
    const auto [squares] = sums<1>([&](std::size_t b, std::ptrdiff_t row, int j, int k) {
      const double *d = direction_[b].data() + row, *image = image_[b].data() + row;
      double *r = residual_[b].data() + row, *to = p[b].data() + row;
      float* rounded = rounded_residual(b, j, k);
      return std::array{sum_row(cells_of_row(b), [=, move = length * unit](std::ptrdiff_t i) {
        to[i] += move * d[i];
        r[i] -= length * image[i];
        rounded[i] = float(rounded_scale * r[i]);
        return r[i] * r[i];
      })};
    });
    return std::sqrt(squares);
  }

  /// Returns the norm of what is left.
  double take_off(BlockFields& q, double mean) {
    const auto [squares] = sums<1>([&](std::size_t b, std::ptrdiff_t row, int, int) {
      double* v = q[b].data() + row;
      return std::array{sum_row(cells_of_row(b), [=](std::ptrdiff_t i) {
        v[i] -= mean;
        return v[i] * v[i];
      })};
    });
    return std::sqrt(squares);
  }

  void take_mean_off(BlockFields& q) {
    const auto [sum] = sums<1>([&](std::size_t b, std::ptrdiff_t row, int, int) {
      const double* v = q[b].data() + row;
      return std::array{sum_row(cells_of_row(b), [=](std::ptrdiff_t i) { return v[i]; })};
    });
    take_off(q, sum / cells_);
  }

  const Mesh& mesh_;
  bool singular_;
  double tolerance_;
  double cells_ = 0; ///< of all ranks
  Multigrid multigrid_;
  Halo halo_;
  BlockFields residual_, direction_, image_;
  /// Per block and direction: that of the system, or 0 where a direction couples nothing.
  std::vector<std::array<double, 3>> scales_;
  const PressureSystem* system_ = nullptr; ///< being solved
  double rhs_scale_ = 1;                   ///< power of 2 between rhs and residual
  double residual_scale_ = 1;              ///< between residual and its rounded copy
  std::vector<double> room_;
};

} // namespace

std::unique_ptr<PressureSolver> make_multigrid_pressure_solver(const Mesh& mesh, bool singular,
                                                               double tolerance) {
  return std::make_unique<MultigridPressureSolver>(mesh, singular, tolerance);
}

} // namespace granflux::cfd
