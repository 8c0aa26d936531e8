// SPDX-FileCopyrightText: 2026 The GranFlux developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <cmath>
#include <gtest/gtest.h>
#include <map>
#include <numbers>

#include <granflux/cfd/halo.hpp>
#include <granflux/cfd/join_blocks.hpp>
#include <granflux/cfd/mesh.hpp>

namespace granflux::cfd::testing {

inline constexpr double pi = std::numbers::pi;

inline Vec3 vector_at(const VectorField& field, std::ptrdiff_t c) {
  return {field[0][c], field[1][c], field[2][c]};
}

/// body(block index, position, cell) for every interior cell of this rank.
template <class Body> void for_cells(const Mesh& mesh, Body&& body) {
  for (std::size_t b = 0; b < mesh.local.size(); ++b) {
    const Layout& layout = mesh.local[b].layout;
    for (int k = 0; k < layout.cells[2]; ++k)
      for (int j = 0; j < layout.cells[1]; ++j)
        for (int i = 0; i < layout.cells[0]; ++i)
          body(b, layout.at(i, j, k), Index3{i, j, k});
  }
}

/// Over all cells of all ranks.
inline double total_volume(const Mesh& mesh) {
  double sum = 0;
  for_cells(mesh, [&](std::size_t b, std::ptrdiff_t c, const Index3&) {
    sum += mesh.local[b].volume[c];
  });
  MPI_Allreduce(MPI_IN_PLACE, &sum, 1, MPI_DOUBLE, MPI_SUM, mesh.comm);
  return sum;
}

/// Largest sum of a cell's outward areas, relative to its surface.
inline double largest_gap(const Mesh& mesh) {
  double worst = 0;
  for_cells(mesh, [&](std::size_t b, std::ptrdiff_t c, const Index3&) {
    const Block& block = mesh.local[b];
    Vec3 sum;
    double surface = 0;
    for (std::size_t d = 0; d < 3; ++d) {
      const Vec3 low = vector_at(block.area[d], c),
                 high = vector_at(block.area[d], c + block.layout.stride[d]);
      sum += high - low;
      surface += norm(high) + norm(low);
    }
    worst = std::max(worst, norm(sum) / surface);
  });
  MPI_Allreduce(MPI_IN_PLACE, &worst, 1, MPI_DOUBLE, MPI_MAX, mesh.comm);
  return worst;
}

/// Outward area of a boundary: the sum of the lengths of its face vectors.
inline double boundary_area(const Mesh& mesh, const std::string& name) {
  double sum = 0;
  for (const Block& block : mesh.local)
    for (const Patch& patch : mesh.info(block).patches) {
      if (patch.link || mesh.boundaries[std::size_t(patch.boundary)] != name)
        continue;
      const auto d = std::size_t(patch.side.direction);
      for (int k = patch.cells.lo[2]; k < patch.cells.hi[2]; ++k)
        for (int j = patch.cells.lo[1]; j < patch.cells.hi[1]; ++j)
          for (int i = patch.cells.lo[0]; i < patch.cells.hi[0]; ++i) {
            const std::ptrdiff_t c = block.layout.at(i, j, k);
            sum += norm(vector_at(block.area[d], patch.side.high ? c + block.layout.stride[d] : c));
          }
    }
  MPI_Allreduce(MPI_IN_PLACE, &sum, 1, MPI_DOUBLE, MPI_SUM, mesh.comm);
  return sum;
}

/// Nodes of the two blocks of every link are the same points, bit for bit but for the shift, and
/// the donor's patch answers. Returns the number of links.
inline int expect_links_meet(const Grid& grid, double tolerance = 0) {
  int links = 0;
  for (int id = 0; id < int(grid.blocks.size()); ++id) {
    const GridBlock& block = grid.blocks[std::size_t(id)];
    for (const Patch& patch : block.patches) {
      if (!patch.link)
        continue;
      ++links;
      const GridBlock& other = grid.blocks[std::size_t(patch.link->block)];
      const Patch back = answer(id, patch);
      const auto answers = [&](const Patch& p) {
        return p.link && p.side == back.side && p.cells.lo == back.cells.lo &&
               p.cells.hi == back.cells.hi && p.link->block == id &&
               p.link->axis == back.link->axis && p.link->sign == back.link->sign &&
               p.link->offset == back.link->offset &&
               norm(p.link->shift - back.link->shift) <= 1e-15;
      };
      EXPECT_EQ(std::count_if(other.patches.begin(), other.patches.end(), answers), 1)
          << "block " << id << " to " << patch.link->block;
      // Node n is the low corner of cell n: where the order turns, the donor's node is one further.
      IndexBox nodes = patch.cells;
      const auto normal = std::size_t(patch.side.direction);
      for (std::size_t d = 0; d < 3; ++d)
        if (d != normal)
          ++nodes.hi[d];
      if (patch.side.high)
        ++nodes.lo[normal], ++nodes.hi[normal];
      for (int k = nodes.lo[2]; k < nodes.hi[2]; ++k)
        for (int j = nodes.lo[1]; j < nodes.hi[1]; ++j)
          for (int i = nodes.lo[0]; i < nodes.hi[0]; ++i) {
            Index3 n = patch.link->donor({i, j, k});
            for (std::size_t a = 0; a < 3; ++a)
              n[a] += patch.link->sign[a] < 0 ? 1 : 0;
            const Vec3 here = block.node(i, j, k);
            const Vec3 there = other.node(n[0], n[1], n[2]) + patch.link->shift;
            EXPECT_LE(norm(here - there), patch.link->shift == Vec3{} ? tolerance : 1e-14)
                << "block " << id << " node " << i << ' ' << j << ' ' << k;
          }
    }
  }
  return links;
}

/// Every ghost cell behind a link, both layers, is the donor's cell: its centre, less the shift, is
/// that of an interior cell and lies on the right side of the face, one or two cells further on.
inline void expect_ghosts_follow(const Mesh& mesh) {
  for (const Block& block : mesh.local)
    for (const Patch& patch : mesh.info(block).patches) {
      if (!patch.link)
        continue;
      const auto d = std::size_t(patch.side.direction);
      const std::ptrdiff_t out = patch.side.high ? block.layout.stride[d] : -block.layout.stride[d];
      for (int k = patch.cells.lo[2]; k < patch.cells.hi[2]; ++k)
        for (int j = patch.cells.lo[1]; j < patch.cells.hi[1]; ++j)
          for (int i = patch.cells.lo[0]; i < patch.cells.hi[0]; ++i) {
            const std::ptrdiff_t c = block.layout.at(i, j, k);
            const Vec3 area =
                vector_at(block.area[d], patch.side.high ? c + block.layout.stride[d] : c) *
                (patch.side.high ? 1. : -1.);
            const Vec3 x = vector_at(block.centre, c), first = vector_at(block.centre, c + out);
            const double width = block.volume[c] / norm(area);
            const double beyond = dot(first - x, area) / norm(area);
            const double ghost_width = block.volume[c + out] / norm(area);
            EXPECT_GT(block.volume[c + out], 0);
            EXPECT_GT(beyond, 0.3 * (width + ghost_width));
            EXPECT_LT(norm(first - x), 1.2 * (width + ghost_width));
            Index3 two{i, j, k};
            two[d] += patch.side.high ? 2 : -2;
            if (resolve(mesh, {block.id, two})) {
              EXPECT_GT(dot(vector_at(block.centre, c + 2 * out) - first, area), 0);
            }
          }
    }
}

} // namespace granflux::cfd::testing
