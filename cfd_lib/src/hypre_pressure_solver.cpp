// SPDX-FileCopyrightText: 2026 The GranFlux developers
// SPDX-License-Identifier: BSD-3-Clause
#include <granflux/cfd/pressure_solver.hpp>

#include <cmath>
#include <limits>
#include <string>

#include <HYPRE.h>
#include <HYPRE_IJ_mv.h>
#include <HYPRE_krylov.h>
#include <HYPRE_parcsr_ls.h>

#include <granflux/cfd/error.hpp>

#include "cell_numbering.hpp"

namespace granflux::cfd {

namespace {

constexpr int most_iterations = 500;

/// hypre's own numbers for what it is asked to do; reference manual, BoomerAMG.
constexpr int hmis_coarsening = 10, extended_interpolation = 6, interpolation_points = 4;
constexpr double strong = 0.5; ///< threshold that its manual recommends in three dimensions

/// What hypre creates and must destroy.
template <class Handle, HYPRE_Int (*destroy)(Handle)> class Owned {
public:
  Owned() = default;
  Owned(const Owned&) = delete;
  Owned& operator=(const Owned&) = delete;
  ~Owned() { reset(); }
  void reset() {
    if (handle_)
      destroy(handle_);
    handle_ = nullptr;
  }
  Handle* fresh() {
    reset();
    return &handle_;
  }
  [[nodiscard]] Handle get() const { return handle_; }

private:
  Handle handle_ = nullptr;
};

/// hypre is begun with the first solver and ended with the last.
class HypreUse {
public:
  HypreUse() {
    if (users_++ == 0)
      HYPRE_Init();
  }
  HypreUse(const HypreUse&) = delete;
  HypreUse& operator=(const HypreUse&) = delete;
  ~HypreUse() {
    if (--users_ == 0)
      HYPRE_Finalize();
  }

private:
  static inline int users_ = 0;
};

class HyprePressureSolver final : public PressureSolver {
public:
  HyprePressureSolver(const Mesh& mesh, bool singular, double tolerance)
      : mesh_(mesh), singular_(singular), tolerance_(tolerance), numbering_(mesh) {
    int rank = 0;
    MPI_Comm_rank(mesh.comm, &rank);
    begin_ = numbering_.starts[std::size_t(rank)];
    cells_ = numbering_.counts[std::size_t(rank)];
    for (int n = 0; n < cells_; ++n)
      rows_.push_back(begin_ + n);
    for (const Block& block : mesh.local)
      for_each_in_order(block.layout.cells, [&](const Index3& cell) {
        around_.push_back(numbering_.around(block.id, cell));
      });
    const HYPRE_Int last = begin_ + cells_ - 1;
    HYPRE_IJVectorCreate(mesh.comm, begin_, last, rhs_.fresh());
    HYPRE_IJVectorCreate(mesh.comm, begin_, last, solution_.fresh());
    for (const HYPRE_IJVector vector : {rhs_.get(), solution_.get()})
      HYPRE_IJVectorSetObjectType(vector, HYPRE_PARCSR);
  }

  PressureReport solve(const PressureSystem& system, BlockFields& p, FirstGuess guess) override {
    setup(system);
    std::vector<double> b, x;
    each([&](std::size_t block, std::ptrdiff_t c) {
      b.push_back(-system.rhs[block][c]);
      x.push_back(guess == FirstGuess::given ? p[block][c] : 0);
    });
    double sums[2] = {0, 0};
    for (const double value : b)
      sums[0] += value, sums[1] += value * value;
    MPI_Allreduce(MPI_IN_PLACE, sums, 2, MPI_DOUBLE, MPI_SUM, mesh_.comm);
    if (!std::isfinite(sums[1]))
      throw NumericalError("pressure equation: the right-hand side is not a number");
    if (singular_) // rounding has put a part there that no pressure can balance
      for (double& value : b)
        value -= sums[0] / numbering_.cells;
    constexpr double rounding = 4 * std::numeric_limits<double>::epsilon();
    const double enough = rounding * system.scale;
    PressureReport report;
    if (std::sqrt(sums[1]) > enough) {
      set(rhs_.get(), b);
      set(solution_.get(), x);
      report = iterate(enough);
      HYPRE_IJVectorGetValues(solution_.get(), cells_, rows_.data(), x.data());
    } else
      x.assign(x.size(), 0);
    double mean = 0;
    if (singular_) {
      for (const double value : x)
        mean += value / numbering_.cells;
      MPI_Allreduce(MPI_IN_PLACE, &mean, 1, MPI_DOUBLE, MPI_SUM, mesh_.comm);
    }
    std::size_t n = 0;
    each([&](std::size_t block, std::ptrdiff_t c) { p[block][c] = x[n++] - mean; });
    return report;
  }

private:
  /// body(local block, position) for the cells of this rank, in the order of their numbers.
  template <class Body> void each(Body&& body) const {
    for (std::size_t b = 0; b < mesh_.local.size(); ++b)
      for_each_in_order(mesh_.local[b].layout.cells,
                        [&](const Index3& cell) { body(b, mesh_.local[b].layout.at(cell)); });
  }

  void set(HYPRE_IJVector vector, const std::vector<double>& values) const {
    HYPRE_IJVectorInitialize(vector);
    HYPRE_IJVectorSetValues(vector, cells_, rows_.data(), values.data());
    HYPRE_IJVectorAssemble(vector);
  }

  /// Matrix and levels, where the coefficients are not those of the system before.
  void setup(const PressureSystem& system) {
    std::vector<double> coefficients;
    coefficients.reserve(std::size_t(cells_) * CellNumbering::faces);
    each([&](std::size_t b, std::ptrdiff_t c) {
      for (std::size_t d = 0; d < 3; ++d) {
        coefficients.push_back(system.coefficient[b][d][c]);
        coefficients.push_back(system.coefficient[b][d][c + mesh_.local[b].layout.stride[d]]);
      }
    });
    int same = amg_.get() && coefficients == coefficients_ ? 1 : 0;
    MPI_Allreduce(MPI_IN_PLACE, &same, 1, MPI_INT, MPI_MIN, mesh_.comm);
    if (same)
      return;
    coefficients_ = std::move(coefficients);
    fill_matrix();
    HYPRE_BoomerAMGCreate(amg_.fresh());
    HYPRE_BoomerAMGSetCoarsenType(amg_.get(), hmis_coarsening);
    HYPRE_BoomerAMGSetInterpType(amg_.get(), extended_interpolation);
    HYPRE_BoomerAMGSetPMaxElmts(amg_.get(), interpolation_points);
    HYPRE_BoomerAMGSetStrongThreshold(amg_.get(), strong);
    HYPRE_BoomerAMGSetMaxIter(amg_.get(), 1); // one cycle a call, whatever it leaves
    HYPRE_BoomerAMGSetTol(amg_.get(), 0);
    HYPRE_ParCSRPCGCreate(mesh_.comm, krylov_.fresh());
    HYPRE_PCGSetTwoNorm(krylov_.get(), 1);
    HYPRE_PCGSetMaxIter(krylov_.get(), most_iterations);
    HYPRE_PCGSetTol(krylov_.get(), tolerance_);
    HYPRE_ParCSRPCGSetPrecond(krylov_.get(), HYPRE_BoomerAMGSolve, HYPRE_BoomerAMGSetup,
                              amg_.get());
    HYPRE_ParCSRPCGSetup(krylov_.get(), parallel_matrix(), parallel(rhs_.get()),
                         parallel(solution_.get()));
    check("setting up");
  }

  /// The negated matrix: positive definite, or made so by tying the first cell to pressure 0.
  void fill_matrix() {
    const HYPRE_Int last = begin_ + cells_ - 1;
    HYPRE_IJMatrixCreate(mesh_.comm, begin_, last, begin_, last, matrix_.fresh());
    HYPRE_IJMatrixSetObjectType(matrix_.get(), HYPRE_PARCSR);
    HYPRE_IJMatrixInitialize(matrix_.get());
    int bad = 0;
    std::vector<HYPRE_Int> columns;
    std::vector<double> values;
    for (int n = 0; n < cells_; ++n) {
      const int row = begin_ + n;
      const double* c = coefficients_.data() + std::size_t(n) * CellNumbering::faces;
      columns.assign(1, row);
      values.assign(1, 0.0);
      for (std::size_t f = 0; f < CellNumbering::faces; ++f) {
        const int other = around_[std::size_t(n)][f];
        if (other == row)
          continue; // a periodic direction of one cell
        values.front() += c[f];
        if (other >= 0) {
          columns.push_back(other);
          values.push_back(-c[f]);
        }
      }
      bad += values.front() > 0 && std::isfinite(values.front()) ? 0 : 1;
      if (singular_ && row == 0)
        values.front() *= 2;
      HYPRE_Int count = HYPRE_Int(columns.size());
      HYPRE_IJMatrixAddToValues(matrix_.get(), 1, &count, &row, columns.data(), values.data());
    }
    MPI_Allreduce(MPI_IN_PLACE, &bad, 1, MPI_INT, MPI_SUM, mesh_.comm);
    if (bad > 0)
      throw NumericalError("pressure equation: the coefficients of a cell are all zero, or not "
                           "numbers");
    HYPRE_IJMatrixAssemble(matrix_.get());
    for (const HYPRE_IJVector vector : {rhs_.get(), solution_.get()})
      set(vector, std::vector<double>(std::size_t(cells_), 0.0));
  }

  PressureReport iterate(double enough) {
    HYPRE_PCGSetAbsoluteTol(krylov_.get(), enough);
    HYPRE_ParCSRPCGSolve(krylov_.get(), parallel_matrix(), parallel(rhs_.get()),
                         parallel(solution_.get()));
    PressureReport report;
    HYPRE_Int iterations = 0, converged = 0;
    HYPRE_PCGGetNumIterations(krylov_.get(), &iterations);
    HYPRE_PCGGetFinalRelativeResidualNorm(krylov_.get(), &report.residual);
    HYPRE_PCGGetConverged(krylov_.get(), &converged);
    report.iterations = iterations;
    if (!converged || !std::isfinite(report.residual))
      throw NumericalError("pressure equation: hypre found no solution in " +
                           std::to_string(iterations) + " iterations: residual " +
                           std::to_string(report.residual) + " of the right-hand side");
    check("solving");
    return report;
  }

  /// Collective: hypre's error flag of any rank.
  void check(const std::string& doing) const {
    int error = HYPRE_GetError();
    HYPRE_ClearAllErrors();
    MPI_Allreduce(MPI_IN_PLACE, &error, 1, MPI_INT, MPI_MAX, mesh_.comm);
    if (error != 0)
      throw NumericalError("pressure equation: hypre reports error " + std::to_string(error) +
                           " while " + doing);
  }

  [[nodiscard]] HYPRE_ParCSRMatrix parallel_matrix() const {
    void* object = nullptr;
    HYPRE_IJMatrixGetObject(matrix_.get(), &object);
    return static_cast<HYPRE_ParCSRMatrix>(object);
  }
  static HYPRE_ParVector parallel(HYPRE_IJVector vector) {
    void* object = nullptr;
    HYPRE_IJVectorGetObject(vector, &object);
    return static_cast<HYPRE_ParVector>(object);
  }

  const Mesh& mesh_;
  bool singular_;
  double tolerance_;
  CellNumbering numbering_;
  int begin_ = 0, cells_ = 0; ///< first number and cells of this rank
  std::vector<HYPRE_Int> rows_;
  std::vector<std::array<int, CellNumbering::faces>> around_;
  std::vector<double> coefficients_; ///< of the matrix, six a cell
  HypreUse use_;
  Owned<HYPRE_IJMatrix, HYPRE_IJMatrixDestroy> matrix_;
  Owned<HYPRE_IJVector, HYPRE_IJVectorDestroy> rhs_, solution_;
  Owned<HYPRE_Solver, HYPRE_BoomerAMGDestroy> amg_;
  Owned<HYPRE_Solver, HYPRE_ParCSRPCGDestroy> krylov_;
};

} // namespace

std::unique_ptr<PressureSolver> make_hypre_pressure_solver(const Mesh& mesh, bool singular,
                                                           double tolerance) {
  return std::make_unique<HyprePressureSolver>(mesh, singular, tolerance);
}

} // namespace granflux::cfd
