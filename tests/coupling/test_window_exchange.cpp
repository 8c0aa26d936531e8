// SPDX-FileCopyrightText: 2026 The GranFlux developers
// SPDX-License-Identifier: BSD-3-Clause

#include <cmath>
#include <gtest/gtest.h>

#include <granflux/cfd/box_mesh.hpp>
#include <granflux/cfd/sweep.hpp>
#include <granflux/coupling/window_exchange.hpp>

namespace {

using namespace granflux;
using coupling::Window;
using coupling::WindowExchange;

/// 8 x 5 x 6 cells of size 1, periodic along x and z, in 2 x 1 x 2 blocks.
cfd::Mesh make_mesh() {
  cfd::BoxGrid grid;
  grid.nodes = {cfd::uniform_nodes(0, 8, 8), cfd::uniform_nodes(0, 5, 5),
                cfd::uniform_nodes(0, 6, 6)};
  grid.periodic = {true, false, true};
  grid.blocks = {2, 1, 2};
  grid.patches = {{"low", {1, false}}, {"high", {1, true}}};
  return cfd::make_box_mesh(grid, MPI_COMM_WORLD);
}

int rank_of(MPI_Comm comm) {
  int rank = 0;
  MPI_Comm_rank(comm, &rank);
  return rank;
}

/// A number for each cell of the lattice, by the place of its centre.
double name_of(double x, double y, double z) {
  return x + 10 * y + 100 * z;
}

double periodic(double x, double length) {
  return x - length * std::floor(x / length);
}

/// Windows that differ from rank to rank, reach through periodic sides, and move with `step`.
Window window_of(int rank, int step) {
  const int at = 3 * rank - 2 + step;
  return {{at, rank % 2, -1 - step}, {at + 4, 5, 3}};
}

TEST(WindowExchange, SamplesTheCellsUnderEachWindow) {
  const cfd::Mesh mesh = make_mesh();
  WindowExchange exchange(mesh);
  cfd::BlockFields name = cfd::make_fields(mesh), twice = cfd::make_fields(mesh);
  for (std::size_t b = 0; b < mesh.local.size(); ++b)
    cfd::for_cells(mesh.local[b].layout, [&](std::ptrdiff_t c) {
      const auto& x = mesh.local[b].centre;
      name[b][c] = name_of(x[0][c], x[1][c], x[2][c]);
      twice[b][c] = 2 * name[b][c];
    });
  const int rank = rank_of(mesh.comm);
  for (int step = 0; step < 6; ++step) { // within a frame and beyond it
    Window window = window_of(rank, step);
    if (rank == 1 && step == 3)
      window = {}; // no particles
    exchange.bind(window);
    std::vector<double> values(2 * window.size(), -1);
    std::vector<const cfd::Field*> fields;
    for (std::size_t b = 0; b < mesh.local.size(); ++b)
      fields.insert(fields.end(), {&name[b], &twice[b]});
    exchange.sample(fields, 2, values);
    for (int k = window.lo[2]; k < window.hi[2]; ++k)
      for (int j = window.lo[1]; j < window.hi[1]; ++j)
        for (int i = window.lo[0]; i < window.hi[0]; ++i) {
          const double wanted = name_of(periodic(i + 0.5, 8), j + 0.5, periodic(k + 0.5, 6));
          EXPECT_EQ(values[2 * window.index({i, j, k})], wanted);
          EXPECT_EQ(values[2 * window.index({i, j, k}) + 1], 2 * wanted);
        }
  }
}

TEST(WindowExchange, DepositIsTheAdjointOfSampling) {
  const cfd::Mesh mesh = make_mesh();
  WindowExchange exchange(mesh);
  const int rank = rank_of(mesh.comm);
  for (int step = 0; step < 6; ++step) {
    const Window window = window_of(rank, step);
    exchange.bind(window);
    std::vector<double> given(window.size());
    for (std::size_t c = 0; c < given.size(); ++c)
      given[c] = double((7 * c + std::size_t(rank)) % 13); // whole numbers: sums are exact
    cfd::BlockFields deposited = cfd::make_fields(mesh), field = cfd::make_fields(mesh);
    double sums[2] = {0, 0}; // <deposit, field> on the blocks, <given, sample> on the windows
    for (std::size_t b = 0; b < mesh.local.size(); ++b)
      cfd::for_cells(mesh.local[b].layout, [&](std::ptrdiff_t c) {
        const auto& x = mesh.local[b].centre;
        field[b][c] = 2 * name_of(x[0][c], x[1][c], x[2][c]);
      });
    const std::array<cfd::BlockFields*, 1> to{&deposited};
    exchange.deposit(given, to);
    for (std::size_t b = 0; b < mesh.local.size(); ++b)
      sums[0] += cfd::sum_cells(mesh.local[b].layout,
                                [&](std::ptrdiff_t c) { return deposited[b][c] * field[b][c]; });
    std::vector<double> sampled(window.size());
    std::vector<const cfd::Field*> from;
    for (const cfd::Field& block : field)
      from.push_back(&block);
    exchange.sample(from, 1, sampled);
    for (std::size_t c = 0; c < given.size(); ++c)
      sums[1] += given[c] * sampled[c];
    MPI_Allreduce(MPI_IN_PLACE, sums, 2, MPI_DOUBLE, MPI_SUM, mesh.comm);
    EXPECT_EQ(sums[0], sums[1]);
    EXPECT_GT(sums[0], 0);
  }
}

} // namespace
