// SPDX-FileCopyrightText: 2026 The GranFlux developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <array>
#include <functional>
#include <mpi.h>
#include <optional>
#include <string>
#include <vector>

#include <granflux/cfd/field.hpp>
#include <granflux/cfd/vec3.hpp>

namespace granflux::cfd {

/// A block has six sides; direction 0, 1, 2 is i, j, k.
struct Side {
  int direction = 0;
  bool high = false;
  friend bool operator==(const Side&, const Side&) = default;
};

/// Cells lo <= (i,j,k) < hi of one block.
struct IndexBox {
  Index3 lo{}, hi{};
  [[nodiscard]] bool contains(const Index3& c) const {
    return c[0] >= lo[0] && c[1] >= lo[1] && c[2] >= lo[2] && c[0] < hi[0] && c[1] < hi[1] &&
           c[2] < hi[2];
  }
  [[nodiscard]] bool empty() const { return lo[0] >= hi[0] || lo[1] >= hi[1] || lo[2] >= hi[2]; }
};

[[nodiscard]] inline IndexBox intersection(const IndexBox& a, const IndexBox& b) {
  IndexBox both;
  for (std::size_t d = 0; d < 3; ++d) {
    both.lo[d] = std::max(a.lo[d], b.lo[d]);
    both.hi[d] = std::min(a.hi[d], b.hi[d]);
  }
  return both;
}

/// One-to-one connection: cell c of this block, continued past the side, is donor cell
/// offset[d] + sign[d] * c[axis[d]] for d = 0, 1, 2. Any orientation.
struct Link {
  int block = -1;
  Index3 axis{0, 1, 2}, sign{1, 1, 1}, offset{};
  /// Where the donor lies as seen from this block is its own position + shift [m]: not zero across
  /// a periodic connection.
  Vec3 shift{};
  [[nodiscard]] Index3 donor(const Index3& c) const {
    return {offset[0] + sign[0] * c[std::size_t(axis[0])],
            offset[1] + sign[1] * c[std::size_t(axis[1])],
            offset[2] + sign[2] * c[std::size_t(axis[2])]};
  }
};

/// A rectangle of one side: its inner cells, and what lies beyond: another block or a boundary.
struct Patch {
  Side side;
  IndexBox cells;           ///< the layer of interior cells that touch the patch
  int boundary = -1;        ///< index into Mesh::boundaries, or -1 for a link
  std::optional<Link> link; ///< set where boundary is -1
};

/// Where a block lies in the grid as it was given, before it was cut for the ranks.
struct Place {
  int block = 0; ///< of the given grid
  Index3 low{};  ///< the block's first cell there
};

/// What every rank knows of every block.
struct BlockInfo {
  Index3 cells{};
  int rank = 0;
  std::vector<Patch> patches; ///< together they cover the six sides once
  Place place{};
};

/// Node (i,j,k) of a block [m], 0 <= i <= cells[0] and so on.
using NodeMap = std::function<Vec3(int i, int j, int k)>;

/// A block before it is anyone's: only the rank that will own it asks for its nodes.
struct GridBlock {
  std::string name; ///< for messages and files
  Index3 cells{};
  NodeMap node;
  std::vector<Patch> patches;   ///< together they cover the six sides once
  std::optional<Place> place{}; ///< none: it is as given
};

/// A multi-block grid as a generator or a file gives it. Index triples (i,j,k) are right-handed:
/// cells have positive volume.
struct Grid {
  std::vector<GridBlock> blocks;
  std::vector<std::string> boundaries; ///< names that Patch::boundary is an index into
};

/// What a mesh that is not orthogonal needs beside areas and conductances.
struct SkewMetrics {
  /// cross[d] = S - conductance * dx: the part of S . grad that two cells do not see [m2].
  std::array<VectorField, 3> cross;
  /// offset[d]: from the point that linear interpolation between the two centres gives, to the
  /// centre of the low face [m].
  std::array<VectorField, 3> offset;
  /// grad q = sum over d of dual[d] (q[+1 along d] - q[-1 along d]) / 2, exact for linear q [1/m].
  std::array<VectorField, 3> dual;
};

/// Geometry of one block that this rank owns, all by finite-volume sums over node positions.
/// Ghost cells behind links have the volume and (shifted) centre of the cell they stand for;
/// those behind boundaries mirror their cell's centre through the face.
struct Block {
  int id = 0; ///< index into Mesh::blocks
  Layout layout;
  VectorField node;                ///< low corner of each cell [m]; high corners are one further
  VectorField centre;              ///< cell centres [m], ghosts included
  Field volume;                    ///< cell volumes [m3], ghosts included
  std::array<VectorField, 3> area; ///< area[d]: vector of the low face in direction d [m2]
  /// conductance[d] = |S|^2 / (S . dx), the two-point part of S . grad over a face [m].
  std::array<Field, 3> conductance;
  /// weight[d]: share of the high cell in linear interpolation to the low face in direction d.
  std::array<Field, 3> weight;
  std::optional<SkewMetrics> skew; ///< only where the mesh is not orthogonal
};

/// A straight box of cells, cut into blocks along coordinate planes: what makes locating a point
/// a matter of arithmetic. Every rank holds it whole.
struct Lattice {
  std::array<std::vector<double>, 3> nodes; ///< node coordinates along x, y, z [m], increasing
  std::array<bool, 3> periodic{};
  std::array<std::vector<int>, 3> starts; ///< first cell of each slab of blocks, then the end

  [[nodiscard]] Index3 cells() const {
    return {int(nodes[0].size()) - 1, int(nodes[1].size()) - 1, int(nodes[2].size()) - 1};
  }
  [[nodiscard]] Index3 blocks() const {
    return {int(starts[0].size()) - 1, int(starts[1].size()) - 1, int(starts[2].size()) - 1};
  }
  /// Block of a slab triple: i fastest.
  [[nodiscard]] int block(const Index3& slab) const {
    return slab[0] + blocks()[0] * (slab[1] + blocks()[1] * slab[2]);
  }
};

/// Multi-block structured mesh, its blocks dealt out to the ranks of a communicator.
struct Mesh {
  MPI_Comm comm = MPI_COMM_WORLD;
  std::vector<BlockInfo> blocks;       ///< all blocks
  std::vector<Block> local;            ///< those of this rank, by increasing id
  std::vector<std::string> boundaries; ///< names of the boundary patches
  std::vector<Index3> given;           ///< cells of each block of the grid as it was given
  bool orthogonal = true;              ///< no block of any rank has SkewMetrics
  std::optional<Lattice> lattice;      ///< set for box meshes

  [[nodiscard]] const BlockInfo& info(const Block& b) const { return blocks[std::size_t(b.id)]; }
  /// Of a block of this rank, in `local`.
  [[nodiscard]] std::size_t local_index(int id) const {
    const auto found = std::ranges::lower_bound(local, id, {}, &Block::id);
    return std::size_t(found - local.begin());
  }
};

/// A cell of any block.
struct CellRef {
  int block = 0;
  Index3 cell{};
  Vec3 shift{}; ///< sum over the links followed [m]
};

/// Follows links until `ref` is an interior cell; nothing where it lies behind a boundary. `ref`
/// may be outside its block along one direction only.
std::optional<CellRef> resolve(const Mesh& mesh, CellRef ref);

/// Deals the blocks to the ranks by cost, in their order, and computes the geometry of each rank's
/// own. Collective. Throws ConfigError on all ranks: fewer blocks than ranks, sides that are not
/// covered once, links that do not answer each other or whose nodes do not meet, and cells without
/// a positive volume, with block and index.
Mesh make_mesh(const Grid& grid, MPI_Comm comm);

/// Fields of the right shapes for the local blocks.
BlockFields make_fields(const Mesh& mesh, double value = 0);
BlockVectors make_vectors(const Mesh& mesh, Vec3 value = {});

} // namespace granflux::cfd
