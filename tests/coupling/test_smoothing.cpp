// SPDX-FileCopyrightText: 2026 The GranFlux developers
// SPDX-License-Identifier: BSD-3-Clause

#include <algorithm>
#include <cmath>
#include <functional>
#include <gtest/gtest.h>
#include <limits>
#include <random>

#include <granflux/cfd/error.hpp>
#include <granflux/coupling/smoothing.hpp>

#include "sample_lattices.hpp"

using namespace granflux;
using namespace granflux::coupling;
using cfd::BlockFields;
using cfd::Index3;

namespace {

/// The lattice cell of an interior cell of a local block.
Index3 global_cell(const cfd::Mesh& mesh, const cfd::Block& block, Index3 c) {
  const auto n = mesh.lattice->blocks();
  const Index3 slab{block.id % n[0], block.id / n[0] % n[1], block.id / (n[0] * n[1])};
  for (std::size_t d = 0; d < 3; ++d)
    c[d] += mesh.lattice->starts[d][std::size_t(slab[d])];
  return c;
}

/// body(index into mesh.local, position in memory, lattice cell) for all interior cells.
template <class Body> void for_cells(const cfd::Mesh& mesh, Body&& body) {
  for (std::size_t b = 0; b < mesh.local.size(); ++b) {
    const auto& layout = mesh.local[b].layout;
    for (int k = 0; k < layout.cells[2]; ++k)
      for (int j = 0; j < layout.cells[1]; ++j)
        for (int i = 0; i < layout.cells[0]; ++i)
          body(b, layout.at(i, j, k), global_cell(mesh, mesh.local[b], {i, j, k}));
  }
}

/// Noise that depends on the lattice cell alone.
double noise(const Index3& c, int seed) {
  std::mt19937 random(unsigned(c[0] + 100 * (c[1] + 100 * (c[2] + 100 * seed))));
  random.discard(3);
  return std::uniform_real_distribution(-1., 1.)(random);
}

BlockFields noise_field(const cfd::Mesh& mesh, int seed) {
  auto f = cfd::make_fields(mesh);
  for_cells(mesh, [&](std::size_t b, auto c, const Index3& g) { f[b][c] = noise(g, seed); });
  return f;
}

/// sum f g V over all ranks, and sum |f g| V.
std::array<double, 2> product(const cfd::Mesh& mesh, const BlockFields& f, const BlockFields& g) {
  std::array<double, 2> sum{};
  for_cells(mesh, [&](std::size_t b, auto c, const Index3&) {
    const double term = f[b][c] * g[b][c] * mesh.local[b].volume[c];
    sum[0] += term, sum[1] += std::abs(term);
  });
  MPI_Allreduce(MPI_IN_PLACE, sum.data(), 2, MPI_DOUBLE, MPI_SUM, mesh.comm);
  return sum;
}

cfd::BoxGrid grid_of(const cfd::Lattice& lattice, Index3 blocks) {
  cfd::BoxGrid grid;
  grid.nodes = lattice.nodes;
  grid.periodic = lattice.periodic;
  grid.blocks = blocks;
  for (int d = 0; d < 3; ++d)
    if (!lattice.periodic[std::size_t(d)])
      for (const bool high : {false, true}) {
        cfd::BoxPatch patch;
        patch.name = std::string("side") + char('0' + d) + (high ? "high" : "low");
        patch.side = {d, high};
        grid.patches.push_back(patch);
      }
  return grid;
}

const std::vector<std::array<bool, 3>> peripheries{
    {false, false, false}, {true, false, true}, {true, true, true}};

struct Case {
  cfd::Mesh mesh;
  cfd::Halo halo;
  Smoothing smoothing;
  Case(const cfd::BoxGrid& grid, MPI_Comm comm, double width)
      : mesh(cfd::make_box_mesh(grid, comm)), halo(mesh), smoothing(mesh, halo, width) {}
};

template <class Body> void for_each_case(Body&& body) {
  for (const auto& periodic : peripheries) {
    SCOPED_TRACE(std::string("periodic ") + char('0' + periodic[0]) + char('0' + periodic[1]) +
                 char('0' + periodic[2]));
    Case all(grid_of(sample_lattice(periodic), {2, 2, 2}), MPI_COMM_WORLD, 0.4);
    ASSERT_GT(all.smoothing.substeps(), 3);
    body(all);
  }
}

TEST(Smoothing, Conserves) {
  for_each_case([](Case& it) {
    const auto one = cfd::make_fields(it.mesh, 1);
    auto f = noise_field(it.mesh, 1);
    const auto before = product(it.mesh, f, one);
    it.smoothing.apply({&f});
    EXPECT_NEAR(product(it.mesh, f, one)[0], before[0],
                1e-15 * it.smoothing.substeps() * before[1]);
  });
}

TEST(Smoothing, IsSymmetric) {
  for_each_case([](Case& it) {
    const auto f = noise_field(it.mesh, 1), g = noise_field(it.mesh, 2);
    auto sf = f, sg = g;
    it.smoothing.apply({&sf, &sg});
    const auto left = product(it.mesh, g, sf), right = product(it.mesh, sg, f);
    EXPECT_NEAR(left[0], right[0], 1e-14 * left[1]);
    EXPECT_GT(std::abs(left[0]), 1e-6 * left[1]) << "nothing was compared";
  });
}

TEST(Smoothing, LeavesAConstantAlone) {
  for_each_case([](Case& it) {
    auto f = cfd::make_fields(it.mesh, 0.4);
    it.smoothing.apply({&f});
    for_cells(it.mesh, [&](std::size_t b, auto c, const Index3&) { EXPECT_EQ(f[b][c], 0.4); });
  });
}

TEST(Smoothing, CreatesNoExtremum) {
  for_each_case([](Case& it) {
    auto f = cfd::make_fields(it.mesh); // one full cell, the others empty
    for_cells(it.mesh, [&](std::size_t b, auto c, const Index3& g) {
      f[b][c] = g == Index3{4, 6, 0} ? 1 : 0;
    });
    double most = 1;
    for (int pass = 0; pass < 3; ++pass) {
      it.smoothing.apply({&f});
      double now = 0;
      for_cells(it.mesh, [&](std::size_t b, auto c, const Index3&) {
        EXPECT_GE(f[b][c], 0);
        now = std::max(now, f[b][c]);
      });
      MPI_Allreduce(MPI_IN_PLACE, &now, 1, MPI_DOUBLE, MPI_MAX, it.mesh.comm);
      EXPECT_LT(now, most);
      most = now;
    }
  });
}

// The operator has no negative eigenvalue: <f, S f> >= 0 even for a chequerboard.
TEST(Smoothing, DoesNotOvershoot) {
  for_each_case([](Case& it) {
    auto f = cfd::make_fields(it.mesh);
    for_cells(it.mesh, [&](std::size_t b, auto c, const Index3& g) {
      f[b][c] = (g[0] + g[1] + g[2]) % 2 ? 1 : -1;
    });
    auto sf = f;
    it.smoothing.apply({&sf});
    EXPECT_GE(product(it.mesh, f, sf)[0], 0);
  });
}

// Width b: a point becomes a Gaussian of variance b^2/2 along each axis; on a uniform grid that
// holds exactly, whatever the number of sub-steps.
TEST(Smoothing, SpreadsByTheWidth) {
  cfd::Lattice lattice;
  lattice.nodes = {cfd::uniform_nodes(0, 4.8, 48), cfd::uniform_nodes(0, 4.8, 24),
                   cfd::uniform_nodes(0, 1, 1)};
  lattice.periodic = {false, true, true};
  for (const double width : {0.15, 0.4}) {
    Case it(grid_of(lattice, {2, 2, 1}), MPI_COMM_WORLD, width);
    auto f = cfd::make_fields(it.mesh);
    for_cells(it.mesh, [&](std::size_t b, auto c, const Index3& g) {
      f[b][c] = g[0] == 24 && g[1] == 12 ? 1 : 0;
    });
    it.smoothing.apply({&f});
    double moments[3] = {};
    for_cells(it.mesh, [&](std::size_t b, auto c, const Index3& g) {
      moments[0] += f[b][c];
      moments[1] += f[b][c] * std::pow((g[0] - 24) * 0.1, 2);
      moments[2] += f[b][c] * std::pow((g[1] - 12) * 0.2, 2);
    });
    MPI_Allreduce(MPI_IN_PLACE, moments, 3, MPI_DOUBLE, MPI_SUM, it.mesh.comm);
    EXPECT_NEAR(moments[0], 1, 1e-14);
    EXPECT_NEAR(moments[1], width * width / 2, 1e-10);
    EXPECT_NEAR(moments[2], width * width / 2, 1e-10);
  }
}

// However the box is cut and dealt out: the field on all ranks against one block on each.
TEST(Smoothing, SameForEverySplit) {
  for (const auto& periodic : peripheries)
    for (const Index3 blocks : {Index3{1, 1, 1}, Index3{3, 1, 2}, Index3{2, 3, 1}}) {
      const auto lattice = sample_lattice(periodic);
      Case whole(grid_of(lattice, {1, 1, 1}), MPI_COMM_SELF, 0.4);
      auto expected = noise_field(whole.mesh, 3);
      whole.smoothing.apply({&expected});
      int ranks = 0;
      MPI_Comm_size(MPI_COMM_WORLD, &ranks);
      if (blocks[0] * blocks[1] * blocks[2] < ranks)
        continue;
      Case cut(grid_of(lattice, blocks), MPI_COMM_WORLD, 0.4);
      EXPECT_EQ(cut.smoothing.substeps(), whole.smoothing.substeps());
      auto f = noise_field(cut.mesh, 3);
      cut.smoothing.apply({&f});
      for_cells(cut.mesh, [&](std::size_t b, auto c, const Index3& g) {
        EXPECT_NEAR(f[b][c], expected[0][whole.mesh.local[0].layout.at(g)], 1e-14);
      });
    }
}

TEST(Smoothing, FieldsTogetherAreAsFieldsAlone) {
  Case it(grid_of(sample_lattice({true, false, true}), {2, 2, 1}), MPI_COMM_WORLD, 0.4);
  auto f = noise_field(it.mesh, 1), g = noise_field(it.mesh, 2), h = noise_field(it.mesh, 3);
  auto alone = h;
  it.smoothing.apply({&f, &g, &h});
  it.smoothing.apply({&alone});
  for_cells(it.mesh,
            [&](std::size_t b, auto c, const Index3&) { EXPECT_EQ(h[b][c], alone[b][c]); });
}

TEST(Smoothing, NoWidthIsTheIdentity) {
  Case it(grid_of(sample_lattice({true, false, true}), {2, 2, 1}), MPI_COMM_WORLD, 0);
  EXPECT_EQ(it.smoothing.substeps(), 0);
  auto f = noise_field(it.mesh, 1);
  it.smoothing.apply({&f});
  for_cells(it.mesh,
            [&](std::size_t b, auto c, const Index3& g) { EXPECT_EQ(f[b][c], noise(g, 1)); });
}

// A direction of one cell, however thin, costs no sub-steps.
TEST(Smoothing, SkipsDirectionsOfOneCell) {
  for (const bool periodic : {false, true}) {
    cfd::Lattice plane, thin;
    plane.nodes = {cfd::uniform_nodes(0, 1, 8), cfd::uniform_nodes(0, 1, 8),
                   cfd::uniform_nodes(0, 1, 1)};
    plane.periodic = {true, false, periodic};
    thin = plane;
    thin.nodes[2] = cfd::uniform_nodes(0, 1e-3, 1);
    Case wide(grid_of(plane, {2, 2, 1}), MPI_COMM_WORLD, 0.3);
    Case flat(grid_of(thin, {2, 2, 1}), MPI_COMM_WORLD, 0.3);
    EXPECT_EQ(wide.smoothing.substeps(), flat.smoothing.substeps());
  }
}

TEST(Smoothing, RefusesAWidthThatIsNone) {
  const auto mesh =
      cfd::make_box_mesh(grid_of(sample_lattice({true, true, true}), {2, 2, 1}), MPI_COMM_WORLD);
  const cfd::Halo halo(mesh);
  for (const double width : {-1., std::numeric_limits<double>::quiet_NaN(),
                             std::numeric_limits<double>::infinity(), 1e9})
    EXPECT_THROW(Smoothing(mesh, halo, width), ConfigError) << width;
}

} // namespace
