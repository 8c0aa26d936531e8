// SPDX-FileCopyrightText: 2026 The GranFlux developers
// SPDX-License-Identifier: BSD-3-Clause
#include "coarsest_solver.hpp"

#include "cell_numbering.hpp"
#include "direct_factor.hpp"

namespace granflux::cfd {

namespace {

constexpr int faces_per_cell = CellNumbering::faces;

} // namespace

struct CoarsestSolver::Impl {
  Impl(const Mesh& m, bool is_singular)
      : mesh(m), numbering(m), cells(numbering.cells), neighbours(std::size_t(cells)),
        all(neighbours.size() * faces_per_cell), rhs(cells), factor(is_singular) {
    MPI_Comm_rank(mesh.comm, &rank);
    for (int id = 0; id < int(mesh.blocks.size()); ++id)
      for_each_in_order(mesh.blocks[std::size_t(id)].cells, [&](const Index3& cell) {
        neighbours[std::size_t(numbering.of({id, cell}))] = numbering.around(id, cell);
      });
    mine.resize(std::size_t(numbering.counts[std::size_t(rank)]) * faces_per_cell);
  }

  /// Values of `each` numbers a cell from `mine` of every rank to `to` of all.
  void gather(double* to, int each) {
    std::vector<int> sizes = numbering.counts, offsets = numbering.starts;
    for (std::size_t r = 0; r < sizes.size(); ++r)
      sizes[r] *= each, offsets[r] *= each;
    MPI_Allgatherv(mine.data(), sizes[std::size_t(rank)], MPI_DOUBLE, to, sizes.data(),
                   offsets.data(), MPI_DOUBLE, mesh.comm);
  }

  const Mesh& mesh;
  CellNumbering numbering;
  int rank = 0, cells;
  std::vector<std::array<int, faces_per_cell>> neighbours;
  std::vector<double> mine, all;
  Eigen::VectorXd rhs;
  DirectFactor::Entries entries;
  bool analysed = false;
  DirectFactor factor;
};

CoarsestSolver::CoarsestSolver(const Mesh& mesh, bool singular)
    : impl_(std::make_unique<Impl>(mesh, singular)) {}

CoarsestSolver::~CoarsestSolver() = default;

void CoarsestSolver::factorise(const Level& level) {
  Impl& s = *impl_;
  std::size_t at = 0;
  for (const LevelBlock& block : level.blocks)
    for_each_in_order(block.layout.cells, [&](const Index3& cell) {
      const std::ptrdiff_t c = block.layout.at(cell);
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
    s.entries.emplace_back(n, n, diagonal);
  }
  s.factor.factorise(s.cells, s.entries, s.analysed);
  s.analysed = true;
}

void CoarsestSolver::solve(Level& level) {
  Impl& s = *impl_;
  std::size_t at = 0;
  for (const LevelBlock& block : level.blocks)
    for_each_in_order(block.layout.cells, [&](const Index3& cell) {
      s.mine[at++] = block.rhs.data()[block.layout.at(cell)];
    });
  s.gather(s.rhs.data(), 1);
  const Eigen::VectorXd solution = s.factor.solve(s.rhs);
  for (std::size_t b = 0; b < level.blocks.size(); ++b) {
    LevelBlock& block = level.blocks[b];
    int n = s.numbering.first[std::size_t(level.mesh.local[b].id)];
    double product = 0;
    for_each_in_order(block.layout.cells, [&](const Index3& cell) {
      const std::ptrdiff_t c = block.layout.at(cell);
      block.x.data()[c] = float(solution[n++]);
      product += double(block.rhs.data()[c]) * double(block.x.data()[c]);
    });
    if (!block.products.empty()) // this level is also the finest: all in the first row's place
      block.products.front() = product;
  }
}

} // namespace granflux::cfd
