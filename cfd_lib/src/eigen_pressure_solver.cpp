// SPDX-FileCopyrightText: 2026 The GranFlux developers
// SPDX-License-Identifier: BSD-3-Clause
#include <granflux/cfd/pressure_solver.hpp>

#include <Eigen/IterativeLinearSolvers>
#include <Eigen/SparseCholesky>

#include <granflux/cfd/error.hpp>

#include "cell_numbering.hpp"

namespace granflux::cfd {

namespace {

constexpr int largest_direct = 20000; ///< cells; beyond, the fill of a 3-D factor costs more
constexpr int values_per_cell = 7;    ///< coefficients of six faces, right-hand side

using Matrix = Eigen::SparseMatrix<double>;

class EigenPressureSolver final : public PressureSolver {
public:
  EigenPressureSolver(const Mesh& mesh, bool singular, double tolerance)
      : mesh_(mesh), singular_(singular), tolerance_(tolerance), numbering_(mesh),
        cells_(numbering_.cells) {
    MPI_Comm_rank(mesh.comm, &rank_);
    if (rank_ == 0)
      for (int id = 0; id < int(mesh.blocks.size()); ++id)
        for_each_in_order(mesh.blocks[std::size_t(id)].cells, [&](const Index3& cell) {
          const auto number = std::size_t(numbering_.of({id, cell}));
          neighbours_.resize(std::max(neighbours_.size(), number + 1));
          neighbours_[number] = numbering_.around(id, cell);
        });
  }

  PressureReport solve(const PressureSystem& system, BlockFields& p, FirstGuess) override {
    const std::vector<double> gathered = gather(system);
    std::vector<double> values(std::size_t(cells_) + 3, 0.0); // solution, then the report
    if (rank_ == 0) {
      const PressureReport report = solve_gathered(gathered, values);
      values[std::size_t(cells_)] = report.iterations;
      values[std::size_t(cells_) + 1] = report.residual;
      values[std::size_t(cells_) + 2] = failed_ ? 1 : 0;
    }
    MPI_Bcast(values.data(), int(values.size()), MPI_DOUBLE, 0, mesh_.comm);
    if (values[std::size_t(cells_) + 2] != 0)
      throw NumericalError("pressure equation: the factorisation failed; a coefficient is zero or "
                           "not a number");
    for (std::size_t b = 0; b < mesh_.local.size(); ++b) {
      int n = numbering_.first[std::size_t(mesh_.local[b].id)];
      const Layout& layout = mesh_.local[b].layout;
      for_each_in_order(layout.cells, [&](const Index3& cell) {
        p[b][layout.at(cell)] = values[std::size_t(n++)];
      });
    }
    return {int(values[std::size_t(cells_)]), values[std::size_t(cells_) + 1]};
  }

private:
  std::vector<double> gather(const PressureSystem& system) const {
    std::vector<double> mine;
    mine.reserve(std::size_t(numbering_.counts[std::size_t(rank_)]) * values_per_cell);
    for (std::size_t b = 0; b < mesh_.local.size(); ++b) {
      const Layout& layout = mesh_.local[b].layout;
      for_each_in_order(layout.cells, [&](const Index3& cell) {
        const std::ptrdiff_t c = layout.at(cell);
        for (std::size_t d = 0; d < 3; ++d) {
          mine.push_back(system.coefficient[b][d][c]);
          mine.push_back(system.coefficient[b][d][c + layout.stride[d]]);
        }
        mine.push_back(system.rhs[b][c]);
      });
    }
    std::vector<int> sizes = numbering_.counts, starts = numbering_.starts;
    for (std::size_t r = 0; r < sizes.size(); ++r)
      sizes[r] *= values_per_cell, starts[r] *= values_per_cell;
    std::vector<double> all(rank_ == 0 ? std::size_t(cells_) * values_per_cell : 0);
    MPI_Gatherv(mine.data(), int(mine.size()), MPI_DOUBLE, all.data(), sizes.data(), starts.data(),
                MPI_DOUBLE, 0, mesh_.comm);
    return all;
  }

  /// The negated matrix: positive definite, or made so by tying the first cell to pressure 0.
  void assemble(const std::vector<double>& gathered) {
    std::vector<Eigen::Triplet<double>> entries;
    entries.reserve(std::size_t(cells_) * 4);
    for (int n = 0; n < cells_; ++n) {
      const double* c = gathered.data() + std::size_t(n) * values_per_cell;
      double diagonal = 0;
      for (int f = 0; f < 6; ++f) {
        diagonal += c[f];
        const int other = neighbours_[std::size_t(n)][std::size_t(f)];
        if (other == n)
          diagonal -= c[f]; // a periodic direction of one cell
        else if (other >= 0 && other < n)
          entries.emplace_back(n, other, -c[f]);
      }
      if (singular_ && n == 0)
        diagonal *= 2;
      entries.emplace_back(n, n, diagonal);
    }
    lower_.resize(cells_, cells_);
    lower_.setFromTriplets(entries.begin(), entries.end());
  }

  PressureReport solve_gathered(const std::vector<double>& gathered, std::vector<double>& p) {
    assemble(gathered);
    Eigen::VectorXd rhs(cells_);
    for (int n = 0; n < cells_; ++n)
      rhs[n] = -gathered[std::size_t(n) * values_per_cell + values_per_cell - 1];
    Eigen::VectorXd x;
    PressureReport report;
    if (cells_ <= largest_direct) {
      if (!analysed_)
        direct_.analyzePattern(lower_), analysed_ = true;
      direct_.factorize(lower_);
      failed_ = direct_.info() != Eigen::Success;
      if (failed_)
        return report;
      x = direct_.solve(rhs);
      x += direct_.solve(rhs - lower_.selfadjointView<Eigen::Lower>() * x); // one refinement
    } else {
      iterative_.setTolerance(tolerance_);
      iterative_.compute(lower_);
      failed_ = iterative_.info() != Eigen::Success;
      if (failed_)
        return report;
      if (last_.size() != cells_)
        last_ = Eigen::VectorXd::Zero(cells_);
      x = iterative_.solveWithGuess(rhs, last_);
      last_ = x;
      report.iterations = int(iterative_.iterations());
    }
    const double size = rhs.norm();
    if (size > 0)
      report.residual = (rhs - lower_.selfadjointView<Eigen::Lower>() * x).norm() / size;
    if (singular_)
      x.array() -= x.mean();
    std::copy(x.data(), x.data() + cells_, p.begin());
    return report;
  }

  const Mesh& mesh_;
  bool singular_;
  double tolerance_;
  CellNumbering numbering_;
  int rank_ = 0, cells_;
  std::vector<std::array<int, CellNumbering::faces>> neighbours_; ///< on rank 0
  bool analysed_ = false, failed_ = false;
  Matrix lower_;
  Eigen::SimplicialLDLT<Matrix> direct_;
  Eigen::ConjugateGradient<Matrix, Eigen::Lower, Eigen::IncompleteCholesky<double>> iterative_;
  Eigen::VectorXd last_;
};

} // namespace

std::unique_ptr<PressureSolver> make_eigen_pressure_solver(const Mesh& mesh, bool singular,
                                                           double tolerance) {
  return std::make_unique<EigenPressureSolver>(mesh, singular, tolerance);
}

} // namespace granflux::cfd
