// SPDX-FileCopyrightText: 2026 The GranFlux developers
// SPDX-License-Identifier: BSD-3-Clause

// Iterations of the multigrid pressure solver on body-fitted grids: cells that are stretched
// towards a wall, directions whose roles change across the mesh, blocks that meet three at an edge.

#include <gtest/gtest.h>

#include <granflux/cfd/annulus_grid.hpp>
#include <granflux/cfd/cylinder_grid.hpp>
#include <granflux/cfd/split_blocks.hpp>
#include <granflux/cfd/sweep.hpp>

#include "pressure_problem.hpp"

namespace granflux::cfd {
namespace {

using namespace testing;

/// Conductivity at a place.
using Conductivity = std::function<double(const Vec3&)>;

double uniform(const Vec3&) {
  return 1;
}

int ranks() {
  int ranks = 1;
  MPI_Comm_size(MPI_COMM_WORLD, &ranks);
  return ranks;
}

/// The mesh's conductances times harmonic means of the conductivity, pressure given on the boundary
/// `open`, if there is one of that name; sources of random size.
PressureSystem system_on(const Mesh& mesh, const Conductivity& conductivity,
                         const std::string& open) {
  PressureSystem system;
  system.rhs = make_fields(mesh);
  double sums[2] = {0, 0};
  for (std::size_t b = 0; b < mesh.local.size(); ++b) {
    const Block& block = mesh.local[b];
    const Layout& layout = block.layout;
    const auto at = [&](std::ptrdiff_t c) {
      return conductivity({block.centre[0][c], block.centre[1][c], block.centre[2][c]});
    };
    system.coefficient.push_back({Field(layout), Field(layout), Field(layout)});
    for (int d = 0; d < 3; ++d)
      for_faces(layout, d, [&](std::ptrdiff_t f) {
        const double p = at(f), q = at(f - layout.stride[std::size_t(d)]);
        system.coefficient[b][std::size_t(d)][f] =
            block.conductance[std::size_t(d)][f] * 2 * p * q / (p + q);
      });
    for (const Patch& patch : mesh.info(block).patches) {
      if (patch.link)
        continue;
      const bool given = mesh.boundaries[std::size_t(patch.boundary)] == open;
      const auto d = std::size_t(patch.side.direction);
      for (int k = patch.cells.lo[2]; k < patch.cells.hi[2]; ++k)
        for (int j = patch.cells.lo[1]; j < patch.cells.hi[1]; ++j)
          for (int i = patch.cells.lo[0]; i < patch.cells.hi[0]; ++i) {
            const std::ptrdiff_t cell = layout.at(i, j, k);
            const std::ptrdiff_t face = cell + (patch.side.high ? layout.stride[d] : 0);
            system.coefficient[b][d][face] =
                given ? 2 * std::abs(block.conductance[d][face]) * at(cell) : 0;
          }
    }
    for (int k = 0; k < layout.cells[2]; ++k)
      for (int j = 0; j < layout.cells[1]; ++j)
        for (int i = 0; i < layout.cells[0]; ++i) {
          system.rhs[b][layout.at(i, j, k)] = random_of({i, j, k + 1000 * block.id}, 1) - 0.5;
          sums[0] += system.rhs[b][layout.at(i, j, k)];
          sums[1] += 1;
        }
  }
  MPI_Allreduce(MPI_IN_PLACE, sums, 2, MPI_DOUBLE, MPI_SUM, mesh.comm);
  if (open.empty())
    for_each_cell(mesh, [&](std::size_t b, std::ptrdiff_t c, const Vec3&) {
      system.rhs[b][c] -= sums[0] / sums[1];
    });
  return system;
}

int iterations(const Mesh& mesh, const Conductivity& conductivity = uniform,
               const std::string& open = "") {
  const PressureSystem system = system_on(mesh, conductivity, open);
  BlockFields p = make_fields(mesh);
  return make_multigrid_pressure_solver(mesh, open.empty(), 1e-10)->solve(system, p).iterations;
}

Mesh annulus(int radial, int tangential, double growth, double outer_radius) {
  AnnulusGrid grid;
  grid.inner_radius = 0.5;
  grid.outer_radius = outer_radius;
  grid.length = 0.1;
  grid.radial = radial;
  grid.tangential = tangential;
  grid.axial = 1;
  grid.growth = growth;
  grid.periodic_axis = true;
  return make_mesh(split_for_ranks(make_annulus(grid), ranks()), MPI_COMM_WORLD);
}

TEST(MultigridGrids, AnnulusStretchedTowardsTheWall) {
  struct Case {
    int radial, tangential;
    double growth, outer_radius;
  };
  for (const Case& one : {Case{64, 128, 1.1, 1},
                          {64, 128, 1, 20},
                          {64, 128, 1.1, 20},
                          {48, 96, 1.15, 30},
                          {96, 128, 1.1, 40},
                          {128, 256, 1.05, 40}}) {
    const Mesh mesh = annulus(one.radial, one.tangential, one.growth, one.outer_radius);
    EXPECT_LT(iterations(mesh), 25) << one.radial << " cells, growth " << one.growth;
    EXPECT_LT(iterations(mesh, uniform, "outer"), 25) << one.radial << ", growth " << one.growth;
  }
}

Mesh cylinder(int core, double growth) {
  CylinderGrid grid;
  grid.radius = 0.1;
  grid.length = 0.3;
  grid.core = core;
  grid.radial = core / 2 + 2;
  grid.axial = 2 * core;
  grid.growth = growth;
  return make_mesh(split_for_ranks(make_cylinder(grid), ranks()), MPI_COMM_WORLD);
}

TEST(MultigridGrids, FiveBlockCylinder) {
  const auto bed = [](const Vec3& x) { return x.z < 0.1 ? 1e-6 : 1; };
  const auto bubble = [](const Vec3& x) {
    return x.x * x.x + x.y * x.y + (x.z - 0.15) * (x.z - 0.15) < 0.05 * 0.05 ? 1e6 : 1;
  };
  for (const double growth : {1.0, 0.8}) {
    int coarse = 0;
    for (const int core : {8, 16}) {
      const Mesh mesh = cylinder(core, growth);
      const int closed = iterations(mesh);
      EXPECT_LT(closed, 15);
      EXPECT_LE(closed, core == 8 ? 25 : coarse + 3);
      coarse = closed;
      EXPECT_LT(iterations(mesh, uniform, "high"), 15);
      EXPECT_LT(iterations(mesh, bed, "high"), 15);
      EXPECT_LT(iterations(mesh, bubble, "high"), 15);
      EXPECT_LT(iterations(mesh, bubble, "wall"), 15);
    }
  }
}

TEST(MultigridGrids, FiveBlockCylinderWithBubblesThatTouch) {
  const auto bubbles = [](const Vec3& x) {
    for (int ball = 0; ball < 40; ++ball) {
      const auto place = [&](int d) { return random_of({ball, d, 0}, 3); };
      const double dx = x.x - 0.2 * (place(0) - 0.5), dy = x.y - 0.2 * (place(1) - 0.5),
                   dz = x.z - 0.3 * place(2);
      if (dx * dx + dy * dy + dz * dz < 0.025 * 0.025)
        return 1e6;
    }
    return 1.0;
  };
  const auto white_noise = [](const Vec3& x) {
    const auto index = [](double coordinate) { return int(std::floor(1e6 * coordinate)); };
    return random_of({index(x.x), index(x.y), index(x.z)}, 11) < 0.5 ? 1.0 : 1e6;
  };
  for (const double growth : {1.0, 0.8})
    for (const int core : {8, 16}) {
      const Mesh mesh = cylinder(core, growth);
      for (const char* open : {"", "high", "wall"}) {
        EXPECT_LT(iterations(mesh, bubbles, open), 25) << core << growth << open;
        EXPECT_LT(iterations(mesh, white_noise, open), 25) << core << growth << open;
      }
    }
}

TEST(MultigridGrids, AgreeWithTheDirectSolver) {
  for (const Mesh& mesh : {annulus(24, 32, 1.2, 4), cylinder(6, 0.9)}) {
    const PressureSystem system = system_on(mesh, uniform, "");
    BlockFields p = make_fields(mesh), exact = make_fields(mesh);
    make_multigrid_pressure_solver(mesh, true, 1e-13)->solve(system, p);
    make_eigen_pressure_solver(mesh, true, 1e-14)->solve(system, exact);
    const double size =
        largest(mesh, [&](std::size_t b, std::ptrdiff_t c, const Vec3&) { return exact[b][c]; });
    EXPECT_LT(largest(mesh, [&](std::size_t b, std::ptrdiff_t c,
                                const Vec3&) { return p[b][c] - exact[b][c]; }),
              1e-10 * size);
  }
}

} // namespace
} // namespace granflux::cfd
