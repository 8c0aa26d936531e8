// SPDX-FileCopyrightText: 2026 The GranFlux developers
// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <string>

#include <fmt/core.h>

#include <granflux/cfd/deal_blocks.hpp>
#include <granflux/cfd/error.hpp>
#include <granflux/cfd/halo.hpp>
#include <granflux/cfd/join_blocks.hpp>
#include <granflux/cfd/mesh.hpp>

#include "block_geometry.hpp"
#include "throw_alike.hpp"

namespace granflux::cfd {

namespace {

constexpr std::size_t u(int i) {
  return std::size_t(i);
}

std::string block_name(const Grid& grid, int id) {
  const std::string& name = grid.blocks[u(id)].name;
  return "block " + std::to_string(id) + (name.empty() ? "" : " (" + name + ")");
}

std::string cell_name(const Index3& c) {
  return fmt::format("({}, {}, {})", c[0], c[1], c[2]);
}

std::string side_name(const Side& side) {
  return std::string(1, "ijk"[side.direction]) + (side.high ? "_high" : "_low");
}

template <class Body> void for_box(const IndexBox& box, Body&& body) {
  for (int k = box.lo[2]; k < box.hi[2]; ++k)
    for (int j = box.lo[1]; j < box.hi[1]; ++j)
      for (int i = box.lo[0]; i < box.hi[0]; ++i)
        body(Index3{i, j, k});
}

Index3 beyond(Index3 cell, const Side& side, int steps = 1) {
  cell[u(side.direction)] += side.high ? steps : -steps;
  return cell;
}

void check_sides_covered(const Grid& grid, int id) {
  const GridBlock& block = grid.blocks[u(id)];
  for (int d = 0; d < 3; ++d)
    for (const bool high : {false, true}) {
      const Side side{d, high};
      const IndexBox whole = layer(block.cells, side);
      Layout count(block.cells);
      std::vector<char> covered(count.size, 0);
      const auto fail = [&](const Index3& cell, const std::string& what) {
        throw ConfigError("grid: " + block_name(grid, id) + ": the face of cell " +
                          cell_name(cell) + " on side " + side_name(side) + " " + what +
                          ": each face takes one boundary or one connection");
      };
      for (const Patch& patch : block.patches)
        if (patch.side == side)
          for_box(patch.cells, [&](const Index3& cell) {
            if (!whole.contains(cell))
              fail(cell, "does not exist");
            if (covered[u(int(count.at(cell)))]++)
              fail(cell, "is in two patches");
          });
      for_box(whole, [&](const Index3& cell) {
        if (!covered[u(int(count.at(cell)))])
          fail(cell, "has neither a boundary nor a connection");
      });
    }
}

/// What lies behind a link must find its way back.
void check_links_answer(const Grid& grid, const Mesh& mesh, int id) {
  for (const Patch& patch : grid.blocks[u(id)].patches) {
    if (!patch.link)
      continue;
    for_box(patch.cells, [&](const Index3& cell) {
      const Index3 inside = patch.link->donor(cell);
      const Index3 outside = patch.link->donor(beyond(cell, patch.side));
      const auto fail = [&] {
        throw ConfigError("grid: " + block_name(grid, id) + ": side " + side_name(patch.side) +
                          " is connected at cell " + cell_name(cell) + " to cell " +
                          cell_name(outside) + " of block " + std::to_string(patch.link->block) +
                          ", which is not connected back");
      };
      const int other = patch.link->block;
      if (other < 0 || other >= int(grid.blocks.size()))
        fail();
      const IndexBox theirs{{0, 0, 0}, grid.blocks[u(other)].cells};
      if (!theirs.contains(outside) || theirs.contains(inside))
        fail();
      const auto back = resolve(mesh, {other, inside});
      if (!back || back->block != id || back->cell != cell)
        fail();
    });
  }
}

void deal(Mesh& mesh, const Grid& grid) {
  int ranks = 1;
  MPI_Comm_size(mesh.comm, &ranks);
  std::vector<std::int64_t> cost;
  for (const GridBlock& block : grid.blocks)
    cost.push_back(cell_count(block.cells));
  const std::vector<int> rank_of = deal_blocks(cost, ranks);
  for (std::size_t id = 0; id < grid.blocks.size(); ++id) {
    const GridBlock& block = grid.blocks[id];
    const Place place = block.place.value_or(Place{.block = int(id), .low = {}});
    mesh.blocks.push_back({block.cells, rank_of[id], block.patches, place});
    mesh.given.resize(std::max(mesh.given.size(), u(place.block + 1)));
    Index3& whole = mesh.given[u(place.block)];
    for (std::size_t d = 0; d < 3; ++d)
      whole[d] = std::max(whole[d], place.low[d] + block.cells[d]);
  }
}

/// body(position of the ghost, resolved cell, or nothing at a boundary) for the ghosts of a patch.
template <class Body> void for_ghosts(const Mesh& mesh, const Block& block, Body&& body) {
  for (const Patch& patch : mesh.info(block).patches)
    for (int steps = 1; steps <= ghost_layers; ++steps)
      for_box(patch.cells, [&](const Index3& cell) {
        const Index3 ghost = beyond(cell, patch.side, steps);
        body(patch, cell, steps, block.layout.at(ghost),
             patch.link ? resolve(mesh, {block.id, ghost}) : std::nullopt);
      });
}

void fill_ghost_geometry(Mesh& mesh) {
  const Halo halo(mesh);
  BlockFields volume = make_fields(mesh);
  BlockVectors centre = make_vectors(mesh);
  for (std::size_t b = 0; b < mesh.local.size(); ++b) {
    volume[b] = mesh.local[b].volume;
    centre[b] = mesh.local[b].centre;
  }
  halo.exchange({&volume});
  halo.exchange(centre);
  for (std::size_t b = 0; b < mesh.local.size(); ++b) {
    Block& block = mesh.local[b];
    block.volume = volume[b];
    block.centre = centre[b];
    for_ghosts(mesh, block,
               [&](const Patch& patch, const Index3& cell, int steps, std::ptrdiff_t ghost,
                   const std::optional<CellRef>& donor) {
                 if (donor) {
                   set(block.centre, ghost, get(block.centre, ghost) + donor->shift);
                   return;
                 }
                 // Mirrored through the face that the boundary lies on.
                 const std::ptrdiff_t c = block.layout.at(cell);
                 const std::ptrdiff_t face =
                     patch.side.high ? c + block.layout.stride[u(patch.side.direction)] : c;
                 if (steps == 1 && !patch.link)
                   set(block.centre, ghost,
                       2 * low_face_centre(block, patch.side.direction, face) -
                           get(block.centre, c));
                 block.volume[ghost] = block.volume[c];
               });
  }
}

/// Faces that a link joins must be the same face: their centres are compared.
std::string link_gap(const Mesh& mesh, const Grid& grid) {
  const Halo halo(mesh, 1);
  std::string error;
  for (int d = 0; d < 3; ++d)
    for (const bool high : {false, true}) {
      const Side theirs{d, high};
      BlockVectors faces = make_vectors(mesh);
      for (std::size_t b = 0; b < mesh.local.size(); ++b) {
        const Block& block = mesh.local[b];
        for_box({{0, 0, 0}, block.layout.cells}, [&](const Index3& cell) {
          const std::ptrdiff_t c = block.layout.at(cell);
          set(faces[b], c, low_face_centre(block, d, high ? c + block.layout.stride[u(d)] : c));
        });
      }
      halo.exchange(faces);
      for (std::size_t b = 0; b < mesh.local.size(); ++b) {
        const Block& block = mesh.local[b];
        for (const Patch& patch : mesh.info(block).patches) {
          if (!patch.link)
            continue;
          const Link& link = *patch.link;
          int across = 0; // the donor's direction that runs on across the side
          while (link.axis[u(across)] != patch.side.direction)
            ++across;
          if (theirs != Side{across, (link.sign[u(across)] > 0) != patch.side.high})
            continue;
          for_box(patch.cells, [&](const Index3& cell) {
            const std::ptrdiff_t c = block.layout.at(cell);
            const std::ptrdiff_t s = block.layout.stride[u(patch.side.direction)];
            const Vec3 own =
                low_face_centre(block, patch.side.direction, patch.side.high ? c + s : c);
            const Vec3 other = get(faces[b], patch.side.high ? c + s : c - s) + link.shift;
            const double size = std::cbrt(block.volume[c]);
            if (error.empty() && !(norm(own - other) <= 1e-6 * size))
              error = "grid: " + block_name(grid, block.id) + ": the face of cell " +
                      cell_name(cell) + " on side " + side_name(patch.side) + " lies " +
                      std::to_string(norm(own - other)) + " m off the face of " +
                      block_name(grid, link.block) +
                      " that it is connected to: nodes must coincide, one to one";
          });
        }
      }
    }
  return error;
}

} // namespace

Mesh make_mesh(const Grid& grid, MPI_Comm comm) {
  Mesh mesh;
  mesh.comm = comm;
  mesh.boundaries = grid.boundaries;
  deal(mesh, grid);
  for (int id = 0; id < int(grid.blocks.size()); ++id) {
    check_sides_covered(grid, id);
    check_links_answer(grid, mesh, id);
  }
  int rank = 0;
  MPI_Comm_rank(comm, &rank);
  std::string error;
  for (int id = 0; id < int(grid.blocks.size()); ++id)
    try {
      if (mesh.blocks[u(id)].rank == rank && error.empty())
        mesh.local.push_back(make_block(id, grid.blocks[u(id)]));
    } catch (const ConfigError& e) {
      error = e.what();
    }
  throw_alike(comm, error);
  fill_ghost_geometry(mesh);
  throw_alike(comm, link_gap(mesh, grid));

  int orthogonal = 1;
  for (Block& block : mesh.local) {
    add_two_point_metrics(block);
    orthogonal = orthogonal && is_orthogonal(block);
  }
  MPI_Allreduce(MPI_IN_PLACE, &orthogonal, 1, MPI_INT, MPI_MIN, comm);
  mesh.orthogonal = orthogonal;
  if (!mesh.orthogonal)
    for (Block& block : mesh.local)
      add_skew_metrics(block);
  return mesh;
}

} // namespace granflux::cfd
