// SPDX-FileCopyrightText: 2026 The GranFlux developers
// SPDX-License-Identifier: BSD-3-Clause
#include <granflux/cfd/pressure_solver.hpp>

#include <Eigen/IterativeLinearSolvers>
#include <Eigen/SparseCholesky>

#include <granflux/cfd/error.hpp>

namespace granflux::cfd {

namespace {

constexpr int largest_direct = 20000; ///< cells; beyond, the fill of a 3-D factor costs more
constexpr int values_per_cell = 7;    ///< coefficients of six faces, right-hand side

using Matrix = Eigen::SparseMatrix<double>;

class EigenPressureSolver final : public PressureSolver {
public:
  EigenPressureSolver(const Mesh& mesh, bool singular, double tolerance)
      : mesh_(mesh), singular_(singular), tolerance_(tolerance) {
    MPI_Comm_rank(mesh.comm, &rank_);
    int ranks = 1;
    MPI_Comm_size(mesh.comm, &ranks);
    counts_.assign(std::size_t(ranks), 0);
    for (const BlockInfo& info : mesh.blocks) {
      first_.push_back(cells_);
      const int size = info.cells[0] * info.cells[1] * info.cells[2];
      cells_ += size;
      counts_[std::size_t(info.rank)] += size;
    }
    if (rank_ == 0)
      number_neighbours();
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
      int n = first_[std::size_t(mesh_.local[b].id)];
      for_each_in_order(mesh_.local[b].layout,
                        [&](std::ptrdiff_t c) { p[b][c] = values[std::size_t(n++)]; });
    }
    return {int(values[std::size_t(cells_)]), values[std::size_t(cells_) + 1]};
  }

private:
  template <class Body> static void for_each_in_order(const Layout& layout, Body&& body) {
    for (int k = 0; k < layout.cells[2]; ++k)
      for (int j = 0; j < layout.cells[1]; ++j)
        for (int i = 0; i < layout.cells[0]; ++i)
          body(layout.at(i, j, k));
  }

  /// Global number of the neighbour over each of the six faces, -1 beyond a boundary.
  void number_neighbours() {
    for (int id = 0; id < int(mesh_.blocks.size()); ++id) {
      const Index3 n = mesh_.blocks[std::size_t(id)].cells;
      for (int k = 0; k < n[2]; ++k)
        for (int j = 0; j < n[1]; ++j)
          for (int i = 0; i < n[0]; ++i) {
            std::array<int, 6> around{};
            for (int f = 0; f < 6; ++f) {
              Index3 c{i, j, k};
              c[std::size_t(f / 2)] += f % 2 ? 1 : -1;
              const auto there = resolve(mesh_, {id, c});
              around[std::size_t(f)] = there ? number(*there) : -1;
            }
            neighbours_.push_back(around);
          }
    }
  }

  [[nodiscard]] int number(const CellRef& ref) const {
    const Index3& n = mesh_.blocks[std::size_t(ref.block)].cells;
    return first_[std::size_t(ref.block)] + ref.cell[0] + n[0] * (ref.cell[1] + n[1] * ref.cell[2]);
  }

  std::vector<double> gather(const PressureSystem& system) const {
    std::vector<double> mine;
    mine.reserve(std::size_t(counts_[std::size_t(rank_)]) * values_per_cell);
    for (std::size_t b = 0; b < mesh_.local.size(); ++b) {
      const Layout& layout = mesh_.local[b].layout;
      for_each_in_order(layout, [&](std::ptrdiff_t c) {
        for (std::size_t d = 0; d < 3; ++d) {
          mine.push_back(system.coefficient[b][d][c]);
          mine.push_back(system.coefficient[b][d][c + layout.stride[d]]);
        }
        mine.push_back(system.rhs[b][c]);
      });
    }
    // Ranks own blocks in increasing order, so concatenation by rank is the global numbering.
    std::vector<int> sizes, starts;
    int start = 0;
    for (const int count : counts_) {
      starts.push_back(start);
      sizes.push_back(count * values_per_cell);
      start += sizes.back();
    }
    std::vector<double> all(rank_ == 0 ? std::size_t(start) : 0);
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
  int rank_ = 0, cells_ = 0;
  std::vector<int> first_;  ///< global number of each block's first cell
  std::vector<int> counts_; ///< cells of each rank
  std::vector<std::array<int, 6>> neighbours_;
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
