// SPDX-FileCopyrightText: 2026 The GranFlux developers
// SPDX-License-Identifier: BSD-3-Clause
#include <granflux/cfd/diffusion_solver.hpp>

#include <algorithm>
#include <cmath>

#include <granflux/cfd/error.hpp>
#include <granflux/cfd/row_sweep.hpp>

#include "multigrid_level.hpp"

namespace granflux::cfd {

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

namespace {

/// Powers of 2 round nothing; with them numbers of any size fit into single precision.
double scale_to_one(double size) {
  return size > 0 && std::isfinite(size) ? std::ldexp(1, -std::ilogb(size)) : 1;
}

/// The same cell, or face, in the fields of a level.
std::ptrdiff_t in_level(const Layout& from, const LevelLayout& to, std::ptrdiff_t c) {
  const std::ptrdiff_t beyond = c - from.origin, k = beyond / from.stride[2],
                       j = beyond % from.stride[2] / from.stride[1],
                       i = beyond % from.stride[2] % from.stride[1];
  return to.origin + i + j * to.stride[1] + k * to.stride[2];
}

/// A face of a boundary and the cell inside, as the level sees them: there no boundary face
/// couples, and what its ghost does is part of the mass.
struct BoundedFace {
  std::size_t block, direction;
  std::ptrdiff_t cell, cell_of_level, face;
  float coefficient; ///< half the conductance
  float ghost_factor;
};

/// What single precision is trusted with in one correction: a share of the defect, over the least
/// share of inertia in a diagonal. Numbers are rounded by 6e-8.
constexpr double rounding = 1e-6;

} // namespace

struct DiffusionSolver::Impl {
  Impl(const Mesh& m, const Boundaries& b);
  void take_coefficients(const FaceConductance& conductance);
  void take_inertia();
  void bound(const Unknown& unknown);
  void set_inverse(LevelBlock& block, std::ptrdiff_t row, int n) const;
  void take(const BlockFields& defect, double factor);
  void add(const Unknown& unknown, double factor);

  const Mesh& mesh;
  const Boundaries& boundaries;
  const BlockFields* inertia = nullptr;
  double half_width = 0; ///< of the spectrum about 1
  double scale = 1;      ///< of the operator in the level
  std::vector<BoundedFace> bounded;
  Smoothing smoothing{0, 1, 0};
  Level level;
};

DiffusionSolver::Impl::Impl(const Mesh& m, const Boundaries& b)
    : mesh(m), boundaries(b), level(m, smoothing) {
  for (LevelBlock& block : level.blocks)
    block.mass = FloatField(block.layout.size);
  for (const BoundaryPatch& patch : boundaries.patches()) {
    const auto block = std::size_t(patch.block);
    const Layout& from = mesh.local[block].layout;
    const LevelLayout& to = level.blocks[block].layout;
    for (const BoundaryFace& face : patch.faces)
      bounded.push_back({block, std::size_t(patch.direction), face.cell,
                         in_level(from, to, face.cell), in_level(from, to, face.face), 0, 0});
  }
}

void DiffusionSolver::Impl::take_coefficients(const FaceConductance& conductance) {
  for (std::size_t b = 0; b < mesh.local.size(); ++b) {
    LevelBlock& block = level.blocks[b];
    const LevelLayout& to = block.layout;
    const Layout& from = mesh.local[b].layout;
    for (std::size_t d = 0; d < 3; ++d) {
      if (closed_on_itself(mesh, mesh.local[b].id, int(d)))
        continue;
      Index3 n = to.cells;
      ++n[d];
      deal(worth_a_team(to), n[1], n[2], [&](int j, int k) {
        const double* g = conductance[b][d].data() + from.at(0, j, k);
        float* taken = block.coefficient[d].data() + to.at(0, j, k);
        const double factor = 0.5 * scale;
#pragma omp simd
        for (int i = 0; i < n[0]; ++i)
          taken[i] = float(factor * g[i]);
      });
    }
  }
  for (BoundedFace& bounded_face : bounded) {
    float& c = level.blocks[bounded_face.block]
                   .coefficient[bounded_face.direction]
                   .data()[bounded_face.face];
    bounded_face.coefficient = c;
    bounded_face.ghost_factor = 1; // as if it were not there
    c = 0;
  }
}

/// 1/(mass + coefficients) for n cells.
void DiffusionSolver::Impl::set_inverse(LevelBlock& block, std::ptrdiff_t row, int n) const {
  const float *mass = block.mass.data() + row, *ci = block.coefficient[0].data() + row,
              *cj = block.coefficient[1].data() + row, *ck = block.coefficient[2].data() + row;
  float* inverse = block.inverse_diagonal.data() + row;
  const std::ptrdiff_t sj = block.layout.stride[1], sk = block.layout.stride[2];
#pragma omp simd
  for (std::ptrdiff_t i = 0; i < n; ++i)
    inverse[i] = 1 / (mass[i] + ci[i] + ci[i + 1] + cj[i] + cj[i + sj] + ck[i] + ck[i + sk]);
}

void DiffusionSolver::Impl::take_inertia() {
  for (std::size_t b = 0; b < mesh.local.size(); ++b) {
    LevelBlock& block = level.blocks[b];
    const Layout& from = mesh.local[b].layout;
    for_rows(block.layout, [&](std::ptrdiff_t row, int j, int k) {
      const double* of_cells = (*inertia)[b].data() + from.at(0, j, k);
      float* mass = block.mass.data() + row;
#pragma omp simd
      for (int i = 0; i < block.layout.cells[0]; ++i)
        mass[i] = float(scale * of_cells[i]);
      set_inverse(block, row, block.layout.cells[0]);
    });
  }
}

/// Brings the ghosts of the unknown into the operator.
void DiffusionSolver::Impl::bound(const Unknown& unknown) {
  bool same = true;
  auto at = bounded.begin();
  for (const BoundaryPatch& patch : boundaries.patches())
    for (const BoundaryFace& face : patch.faces) {
      const auto factor = float(unknown.ghost_factor(patch, face));
      same = same && factor == at->ghost_factor;
      at->ghost_factor = factor;
      ++at;
    }
  if (same)
    return;
  for (const BoundedFace& s : bounded) // a cell may have several
    level.blocks[s.block].mass.data()[s.cell_of_level] = float(scale * (*inertia)[s.block][s.cell]);
  for (const BoundedFace& s : bounded)
    level.blocks[s.block].mass.data()[s.cell_of_level] += (1 - s.ghost_factor) * s.coefficient;
  for (const BoundedFace& s : bounded)
    set_inverse(level.blocks[s.block], s.cell_of_level, 1);
}

void DiffusionSolver::Impl::take(const BlockFields& defect, double factor) {
  for (std::size_t b = 0; b < mesh.local.size(); ++b) {
    LevelBlock& block = level.blocks[b];
    for_rows(block.layout, [&, n = block.layout.cells[0]](std::ptrdiff_t row, int j, int k) {
      const double* d = defect[b].data() + mesh.local[b].layout.at(0, j, k);
      float* rhs = block.rhs.data() + row;
#pragma omp simd
      for (int i = 0; i < n; ++i)
        rhs[i] = float(factor * d[i]);
    });
  }
}

void DiffusionSolver::Impl::add(const Unknown& unknown, double factor) {
  for (std::size_t b = 0; b < mesh.local.size(); ++b) {
    const LevelBlock& block = level.blocks[b];
    double* of_block = unknown.at(b).data();
    for_rows(block.layout, [&, n = block.layout.cells[0]](std::ptrdiff_t row, int j, int k) {
      double* q = of_block + mesh.local[b].layout.at(0, j, k);
      const float* x = block.x.data() + row;
#pragma omp simd
      for (int i = 0; i < n; ++i)
        q[i] += factor * double(x[i]);
    });
  }
}

DiffusionSolver::DiffusionSolver(const Mesh& mesh, const Boundaries& boundaries)
    : impl_(std::make_unique<Impl>(mesh, boundaries)) {}

DiffusionSolver::~DiffusionSolver() = default;

void DiffusionSolver::set_operator(const BlockFields& inertia, const FaceConductance& conductance) {
  Impl& s = *impl_;
  s.inertia = &inertia;
  double most[2] = {0, 0}; // share of diffusion in a diagonal, diagonal
  for (std::size_t b = 0; b < s.mesh.local.size(); ++b) {
    const Layout& layout = s.mesh.local[b].layout;
    const Diffusion spread(layout, conductance[b]);
    const double* mass = inertia[b].data();
    most[0] = std::max(most[0], max_cells(layout, 0, [=](std::ptrdiff_t c) {
                         const double half = 0.5 * spread.faces(c);
                         return half / (mass[c] + half);
                       }));
    most[1] = std::max(most[1], max_cells(layout, 0, [=](std::ptrdiff_t c) {
                         return mass[c] + 0.5 * spread.faces(c);
                       }));
  }
  MPI_Allreduce(MPI_IN_PLACE, most, 2, MPI_DOUBLE, MPI_MAX, s.mesh.comm);
  s.half_width = most[0];
  s.scale = scale_to_one(most[1]);
  s.take_coefficients(conductance);
  s.take_inertia();
}

DiffusionSolver::Report DiffusionSolver::correct(const Unknown& unknown, const BlockFields& defect,
                                                 double size, double enough) {
  constexpr int most_iterations = 5000;
  Impl& s = *impl_;
  const double w = s.half_width;
  const double tells = rounding / (1 - w); // of the defect, in single precision
  Report report;
  report.left = std::max(enough, tells * size);
  // The bound holds in the norm that goes with the diagonal, and for exact numbers: half of what is
  // left is aimed at.
  const double factor = w / (1 + std::sqrt(1 - w * w)); // of one iteration
  const double steps =
      w > 0 ? std::max(1.0, std::ceil(std::log(0.5 * report.left / size) / std::log(factor))) : 1;
  if (!(tells < 0.5) || !(steps < most_iterations))
    throw NumericalError(unknown.name + ": diffusion over a step is " +
                         std::to_string(w / (1 - w)) +
                         " times the inertia of a cell, too much for the solver; use a smaller "
                         "time step");
  report.iterations = int(steps);
  s.smoothing = Smoothing(report.iterations, 1, w);
  s.bound(unknown);
  const double unit = scale_to_one(size);
  s.take(defect, unit);
  smooth(s.level);
  s.add(unknown, s.scale / unit);
  return report;
}

} // namespace granflux::cfd
