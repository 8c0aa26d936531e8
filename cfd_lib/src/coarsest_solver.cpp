// SPDX-FileCopyrightText: 2026 The GranFlux developers
// SPDX-License-Identifier: BSD-3-Clause
#include "coarsest_solver.hpp"

#include <Eigen/SparseCholesky>

#include <granflux/cfd/error.hpp>

namespace granflux::cfd {

namespace {

constexpr int faces_per_cell = 6;

template <class Body> void for_each_in_order(const LevelLayout& layout, Body&& body) {
  for (int k = 0; k < layout.cells[2]; ++k)
    for (int j = 0; j < layout.cells[1]; ++j)
      for (int i = 0; i < layout.cells[0]; ++i)
        body(layout.at(i, j, k));
}

} // namespace

struct CoarsestSolver::Impl {
  Impl(const Mesh& m, bool is_singular) : mesh(m), singular(is_singular) {
    MPI_Comm_rank(mesh.comm, &rank);
    int ranks = 1;
    MPI_Comm_size(mesh.comm, &ranks);
    counts.assign(std::size_t(ranks), 0);
    for (const BlockInfo& info : mesh.blocks) {
      first.push_back(cells);
      const int size = info.cells[0] * info.cells[1] * info.cells[2];
      cells += size;
      counts[std::size_t(info.rank)] += size;
    }
    // Ranks own blocks in increasing order, so concatenation by rank is the global numbering.
    starts.assign(std::size_t(ranks), 0);
    for (std::size_t r = 1; r < starts.size(); ++r)
      starts[r] = starts[r - 1] + counts[r - 1];
    for (int id = 0; id < int(mesh.blocks.size()); ++id) {
      const Index3 n = mesh.blocks[std::size_t(id)].cells;
      for (int k = 0; k < n[2]; ++k)
        for (int j = 0; j < n[1]; ++j)
          for (int i = 0; i < n[0]; ++i) {
            std::array<int, faces_per_cell> around{};
            for (int f = 0; f < faces_per_cell; ++f) {
              Index3 c{i, j, k};
              c[std::size_t(f / 2)] += f % 2 ? 1 : -1;
              const auto there = resolve(mesh, {id, c});
              around[std::size_t(f)] = there ? number(*there) : -1;
            }
            neighbours.push_back(around);
          }
    }
    mine.resize(std::size_t(counts[std::size_t(rank)]) * faces_per_cell);
    all.resize(std::size_t(cells) * faces_per_cell);
    rhs.resize(cells);
    solution.resize(cells);
  }

  [[nodiscard]] int number(const CellRef& ref) const {
    const Index3& n = mesh.blocks[std::size_t(ref.block)].cells;
    return first[std::size_t(ref.block)] + ref.cell[0] + n[0] * (ref.cell[1] + n[1] * ref.cell[2]);
  }

  /// Values of `each` numbers a cell from `mine` of every rank to `to` of all.
  void gather(double* to, int each) {
    std::vector<int> sizes = counts, offsets = starts;
    for (std::size_t r = 0; r < sizes.size(); ++r)
      sizes[r] *= each, offsets[r] *= each;
    MPI_Allgatherv(mine.data(), sizes[std::size_t(rank)], MPI_DOUBLE, to, sizes.data(),
                   offsets.data(), MPI_DOUBLE, mesh.comm);
  }

  const Mesh& mesh;
  bool singular;
  int rank = 0, cells = 0;
  std::vector<int> first;          ///< global number of each block's first cell
  std::vector<int> counts, starts; ///< cells of each rank, and before it
  std::vector<std::array<int, faces_per_cell>> neighbours;
  std::vector<double> mine, all;
  Eigen::VectorXd rhs, solution;
  Eigen::SparseMatrix<double> lower;
  std::vector<Eigen::Triplet<double>> entries;
  bool analysed = false;
  Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> factor;
};

CoarsestSolver::CoarsestSolver(const Mesh& mesh, bool singular)
    : impl_(std::make_unique<Impl>(mesh, singular)) {}

CoarsestSolver::~CoarsestSolver() = default;

void CoarsestSolver::factorise(const Level& level) {
  Impl& s = *impl_;
  std::size_t at = 0;
  for (const LevelBlock& block : level.blocks)
    for_each_in_order(block.layout, [&](std::ptrdiff_t c) {
      for (std::size_t d = 0; d < 3; ++d) {
        s.mine[at++] = block.coefficient[d].data()[c];
        s.mine[at++] = block.coefficient[d].data()[c + block.layout.stride[d]];
      }
    });
  s.gather(s.all.data(), faces_per_cell);

  s.entries.clear();
  for (int n = 0; n < s.cells; ++n) {
    const double* c = s.all.data() + std::size_t(n) * faces_per_cell;
    double diagonal = 0;
    for (int f = 0; f < faces_per_cell; ++f) {
      const int other = s.neighbours[std::size_t(n)][std::size_t(f)];
      if (other == n)
        continue; // a periodic direction of one cell
      diagonal += c[f];
      if (other >= 0 && other < n)
        s.entries.emplace_back(n, other, -c[f]);
    }
    if (s.singular && n == 0) // ties the first cell to 0; the mean is taken off afterwards
      diagonal = diagonal > 0 ? 2 * diagonal : 1;
    s.entries.emplace_back(n, n, diagonal);
  }
  s.lower.resize(s.cells, s.cells);
  s.lower.setFromTriplets(s.entries.begin(), s.entries.end());
  if (!s.analysed)
    s.factor.analyzePattern(s.lower), s.analysed = true;
  s.factor.factorize(s.lower);
  if (s.factor.info() != Eigen::Success)
    throw NumericalError("pressure equation: the coarsest level could not be factorised; a "
                         "coefficient is not a number, or a part of the gas has no opening");
}

void CoarsestSolver::solve(Level& level) {
  Impl& s = *impl_;
  std::size_t at = 0;
  for (const LevelBlock& block : level.blocks)
    for_each_in_order(block.layout, [&](std::ptrdiff_t c) { s.mine[at++] = block.rhs.data()[c]; });
  s.gather(s.rhs.data(), 1);
  if (s.singular)
    s.rhs.array() -= s.rhs.mean();
  s.solution = s.factor.solve(s.rhs);
  if (s.singular)
    s.solution.array() -= s.solution.mean();
  for (std::size_t b = 0; b < level.blocks.size(); ++b) {
    LevelBlock& block = level.blocks[b];
    int n = s.first[std::size_t(level.mesh.local[b].id)];
    double product = 0;
    for_each_in_order(block.layout, [&](std::ptrdiff_t c) {
      block.x.data()[c] = float(s.solution[n++]);
      product += double(block.rhs.data()[c]) * double(block.x.data()[c]);
    });
    if (!block.products.empty()) // this level is also the finest: all in the first row's place
      block.products.front() = product;
  }
}

} // namespace granflux::cfd
