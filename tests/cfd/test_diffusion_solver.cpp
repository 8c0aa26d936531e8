// SPDX-FileCopyrightText: 2026 The GranFlux developers
// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>

#include <gtest/gtest.h>

#include <granflux/cfd/diffusion_solver.hpp>
#include <granflux/cfd/error.hpp>
#include <granflux/cfd/halo.hpp>

#include "box_case.hpp"

using namespace granflux;
using namespace granflux::cfd;
using namespace granflux::cfd::testing;

namespace {

/// inertia q - 1/2 diffusion(q) = rhs on a mesh, from q = 0, with the norms that a user of the
/// solver takes himself.
class Problem {
public:
  Problem(const GasCase& c, double diffusion_over_inertia)
      : mesh_(make_mesh(c, MPI_COMM_WORLD)), halo_(mesh_), boundaries_(mesh_, c.boundaries),
        solver_(mesh_, boundaries_), inertia_(make_fields(mesh_)), rhs_(make_fields(mesh_)),
        q_(make_fields(mesh_)), defect_(make_fields(mesh_)) {
    double most = 0;
    for (const Block& block : mesh_.local)
      conductance_.push_back(block.conductance);
    for_each_cell(mesh_, [&](std::size_t b, std::ptrdiff_t p, const Vec3&) {
      const double spread = Diffusion(mesh_.local[b].layout, conductance_[b]).faces(p);
      most = std::max(most, 0.5 * spread / mesh_.local[b].volume[p]);
    });
    MPI_Allreduce(MPI_IN_PLACE, &most, 1, MPI_DOUBLE, MPI_MAX, mesh_.comm);
    for_each_cell(mesh_, [&](std::size_t b, std::ptrdiff_t p, const Vec3& x) {
      inertia_[b][p] = mesh_.local[b].volume[p] * most / diffusion_over_inertia;
      // Of every wave length, and the same on any number of ranks.
      rhs_[b][p] = inertia_[b][p] * (1 + std::sin(40 * x.x + 7 * x.y) * std::cos(99 * x.z) +
                                     std::sin(1e4 * (x.x + 3 * x.y + 7 * x.z)));
    });
    solver_.set_operator(inertia_, conductance_);
  }

  /// With q's boundary values 0 where `m` is a velocity component that a wall holds.
  double norm_of_defect(int m) {
    halo_.exchange({&q_});
    for (const BoundaryPatch& patch : boundaries_.patches())
      for (const BoundaryFace& face : patch.faces)
        q_[std::size_t(patch.block)][face.ghost] =
            boundaries_.velocity_ghost_factor(patch, face, m) *
            q_[std::size_t(patch.block)][face.cell];
    double squares = 0;
    for_each_cell(mesh_, [&](std::size_t b, std::ptrdiff_t p, const Vec3&) {
      const Diffusion spread(mesh_.local[b].layout, conductance_[b]);
      defect_[b][p] = rhs_[b][p] - inertia_[b][p] * q_[b][p] + 0.5 * spread(q_[b].data(), p);
      squares += defect_[b][p] * defect_[b][p];
    });
    MPI_Allreduce(MPI_IN_PLACE, &squares, 1, MPI_DOUBLE, MPI_SUM, mesh_.comm);
    return std::sqrt(squares);
  }

  DiffusionSolver::Report correct(int m, double size, double enough) {
    const Unknown unknown{"a test", [&](std::size_t b) -> Field& { return q_[b]; },
                          [&](const BoundaryPatch& patch, const BoundaryFace& face) {
                            return boundaries_.velocity_ghost_factor(patch, face, m);
                          }};
    return solver_.correct(unknown, defect_, size, enough);
  }

  void forget() { q_ = make_fields(mesh_); }

private:
  Mesh mesh_;
  Halo halo_;
  Boundaries boundaries_;
  DiffusionSolver solver_;
  FaceConductance conductance_;
  BlockFields inertia_, rhs_, q_, defect_;
};

/// Walls, slip sides, an inlet and an outlet.
GasCase open_box(Index3 cells, Index3 blocks) {
  GasCase c = box_case(cells, {1, 0.7, 1.3}, {false, false, false}, blocks);
  boundary(c, "z_low").kind = BoundaryKind::inlet;
  boundary(c, "z_high").kind = BoundaryKind::outlet;
  boundary(c, "y_low").kind = boundary(c, "y_high").kind = BoundaryKind::slip;
  return c;
}

GasCase stretched_box() {
  GasCase c = open_box({18, 12, 15}, {0, 0, 0});
  for (auto& nodes : box_grid(c).nodes)
    for (double& x : nodes)
      x = x * x * x; // cells from 1e-4 to 0.2
  return c;
}

/// What the report promises holds, for every component, within what single precision tells, over
/// and over until the defect is as small as double precision can make it.
void expect_promises_kept(const GasCase& c, double diffusion_over_inertia) {
  Problem problem(c, diffusion_over_inertia);
  for (int m = 0; m < 3; ++m) {
    problem.forget();
    const double start = problem.norm_of_defect(m);
    double size = start;
    for (const double wanted : {1e-2, 1e-4, 1e-12}) {
      for (int pass = 0; size > wanted * start; ++pass) {
        ASSERT_LT(pass, 12) << "component " << m << ", wanted " << wanted;
        const auto [iterations, left] = problem.correct(m, size, wanted * start);
        size = problem.norm_of_defect(m);
        EXPECT_LE(size, left) << "component " << m << ", wanted " << wanted << ", " << iterations
                              << " iterations";
      }
    }
  }
}

TEST(DiffusionSolver, KeepsItsPromise) {
  for (const double ratio : {1e-3, 0.3, 10.0, 1e3}) {
    SCOPED_TRACE(ratio);
    expect_promises_kept(open_box({20, 16, 18}, {0, 0, 0}), ratio);
    expect_promises_kept(open_box({20, 16, 18}, {2, 1, 3}), ratio);
    expect_promises_kept(box_case({16, 1, 16}, {1, 1, 1}, {true, true, false}), ratio);
  }
}

TEST(DiffusionSolver, KeepsItsPromiseOnStretchedCells) {
  for (const double ratio : {0.3, 10.0, 1e3}) {
    SCOPED_TRACE(ratio);
    expect_promises_kept(stretched_box(), ratio);
  }
}

TEST(DiffusionSolver, NoDiffusionIsADivision) {
  GasCase c = box_case({8, 8, 8}, {1, 1, 1}, {false, false, false});
  Problem problem(c, 1e-20);
  const double size = problem.norm_of_defect(0);
  EXPECT_EQ(problem.correct(0, size, 1e-3 * size).iterations, 1);
  EXPECT_LT(problem.norm_of_defect(0), 1e-6 * size);
}

TEST(DiffusionSolver, TooMuchDiffusionIsAnError) {
  Problem problem(box_case({8, 8, 8}, {1, 1, 1}, {false, false, false}), 1e9);
  const double size = problem.norm_of_defect(0);
  EXPECT_THROW((void)problem.correct(0, size, 1e-3 * size), NumericalError);
}

} // namespace
