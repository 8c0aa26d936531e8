// SPDX-FileCopyrightText: 2026 The GranFlux developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cmath>
#include <cstdint>
#include <functional>

#include <granflux/cfd/pressure_solver.hpp>

#include "box_case.hpp"

namespace granflux::cfd::testing {

/// A number in [0, 1) that depends on cell and seed alone: the same on any cut into blocks.
inline double random_of(const Index3& cell, std::uint64_t seed) {
  std::uint64_t z = seed * 0x9e3779b97f4a7c15u;
  for (const int i : cell) { // splitmix64 (Steele, Lea, Flood 2014)
    z += std::uint64_t(i) + 0x9e3779b97f4a7c15u;
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
    z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
    z ^= z >> 31;
  }
  return double(z >> 11) * 0x1.0p-53;
}

/// Conductivity of a cell of the whole box.
using Medium = std::function<double(const Index3&)>;

/// Which cell of the whole box a block's cell is, whatever way the block's indices run.
struct BlockOrientation {
  Index3 start{};           ///< cell of the box where block cell (0,0,0) would be, not turned
  Index3 cells{};           ///< of the block, along the box's axes
  Index3 axis{0, 1, 2};     ///< axis of the box along which index d of the block runs
  Index3 backward{0, 0, 0}; ///< 1: index d runs against it

  [[nodiscard]] Index3 in_box(const Index3& c) const {
    Index3 g{};
    for (std::size_t d = 0; d < 3; ++d) {
      const auto a = std::size_t(axis[d]);
      g[a] = start[a] + (backward[d] ? cells[a] - 1 - c[d] : c[d]);
    }
    return g;
  }
};

/// A pressure equation on a box mesh: harmonic means of a medium on faces, zero pressure behind
/// z_high where `open`, a random right-hand side.
struct PressureProblem {
  Mesh mesh;
  std::vector<BlockOrientation> orientation; ///< per block
  Vec3 spacing;                              ///< of cells
  Index3 cells{};
  PressureSystem system;
  bool singular = true;
};

inline PressureProblem pressure_problem(const Index3& cells, const Vec3& spacing,
                                        const std::array<bool, 3>& periodic, const Index3& blocks,
                                        MPI_Comm comm = MPI_COMM_WORLD) {
  PressureProblem out;
  const Vec3 size{cells[0] * spacing.x, cells[1] * spacing.y, cells[2] * spacing.z};
  out.mesh = make_mesh(box_case(cells, size, periodic, blocks), comm);
  out.spacing = spacing;
  out.cells = cells;
  const Lattice& lattice = *out.mesh.lattice;
  for (int id = 0; id < int(out.mesh.blocks.size()); ++id) {
    BlockOrientation o;
    const Index3 n = lattice.blocks();
    const Index3 slab{id % n[0], id / n[0] % n[1], id / (n[0] * n[1])};
    for (std::size_t d = 0; d < 3; ++d)
      o.start[d] = lattice.starts[d][std::size_t(slab[d])];
    o.cells = out.mesh.blocks[std::size_t(id)].cells;
    out.orientation.push_back(o);
  }
  return out;
}

/// Turns the indices of one block: its index d shall run along its old direction axis[d].
inline void turn_block(PressureProblem& problem, int id, const Index3& axis,
                       const Index3& backward) {
  Mesh& mesh = problem.mesh;
  mesh.lattice.reset();
  const Index3 old_cells = mesh.blocks[std::size_t(id)].cells;
  const auto u = [](int i) { return std::size_t(i); };
  BlockInfo& info = mesh.blocks[u(id)];
  for (std::size_t d = 0; d < 3; ++d)
    info.cells[d] = old_cells[u(axis[d])];
  for (Patch& patch : info.patches) {
    const Patch old = patch;
    for (int d = 0; d < 3; ++d) {
      const auto a = u(axis[u(d)]);
      const int last = old_cells[a] - 1;
      if (backward[u(d)]) {
        patch.cells.lo[u(d)] = last - (old.cells.hi[a] - 1);
        patch.cells.hi[u(d)] = last - old.cells.lo[a] + 1;
      } else {
        patch.cells.lo[u(d)] = old.cells.lo[a];
        patch.cells.hi[u(d)] = old.cells.hi[a];
      }
      if (old.side.direction == axis[u(d)])
        patch.side = {d, old.side.high != (backward[u(d)] == 1)};
      if (!patch.link)
        continue;
      for (std::size_t e = 0; e < 3; ++e)
        if (old.link->axis[e] == axis[u(d)]) {
          patch.link->axis[e] = d;
          if (backward[u(d)]) {
            patch.link->offset[e] = old.link->offset[e] + old.link->sign[e] * last;
            patch.link->sign[e] = -old.link->sign[e];
          }
        }
    }
  }
  for (BlockInfo& other : mesh.blocks)
    for (Patch& patch : other.patches) {
      if (!patch.link || patch.link->block != id)
        continue;
      const Link old = *patch.link;
      for (std::size_t d = 0; d < 3; ++d) {
        const auto a = u(axis[d]);
        patch.link->axis[d] = old.axis[a];
        patch.link->sign[d] = backward[d] ? -old.sign[a] : old.sign[a];
        patch.link->offset[d] = backward[d] ? old_cells[a] - 1 - old.offset[a] : old.offset[a];
      }
    }
  BlockOrientation& o = problem.orientation[u(id)];
  o.axis = axis;
  o.backward = backward;
  for (Block& block : mesh.local)
    if (block.id == id) {
      block.layout = Layout(info.cells);
      block.conductance = {Field(block.layout), Field(block.layout), Field(block.layout)};
    }
}

/// Area over distance of faces across each axis of the box.
inline Vec3 conductance_of(const Vec3& h) {
  return {h.y * h.z / h.x, h.x * h.z / h.y, h.x * h.y / h.z};
}

/// Coefficients and right-hand side, by the cells of the box.
inline void fill_system(PressureProblem& problem, const Medium& medium, bool open,
                        std::uint64_t seed = 1) {
  Mesh& mesh = problem.mesh;
  const Vec3 g = conductance_of(problem.spacing);
  const auto in_box = [&](const CellRef& ref) {
    return problem.orientation[std::size_t(ref.block)].in_box(ref.cell);
  };
  problem.system.coefficient.clear();
  problem.system.rhs = make_fields(mesh);
  problem.singular = !open;
  for (std::size_t b = 0; b < mesh.local.size(); ++b) {
    Block& block = mesh.local[b];
    problem.system.coefficient.push_back(
        {Field(block.layout), Field(block.layout), Field(block.layout)});
    const BlockOrientation& o = problem.orientation[std::size_t(block.id)];
    for (int d = 0; d < 3; ++d) {
      const int axis = o.axis[std::size_t(d)];
      Index3 n = block.layout.cells;
      ++n[std::size_t(d)];
      for (int k = 0; k < n[2]; ++k)
        for (int j = 0; j < n[1]; ++j)
          for (int i = 0; i < n[0]; ++i) {
            const Index3 above{i, j, k};
            Index3 below = above;
            --below[std::size_t(d)];
            const auto high = resolve(mesh, {block.id, above}),
                       low = resolve(mesh, {block.id, below});
            double value = 0;
            if (high && low) {
              const double p = medium(in_box(*high)), q = medium(in_box(*low));
              value = 2 * p * q / (p + q);
            } else if (open && axis == 2) {
              const Index3 inner = in_box(high ? *high : *low);
              const bool top = (high.has_value()) == (o.backward[std::size_t(d)] == 1);
              value = top && inner[2] == problem.cells[2] - 1 ? 2 * medium(inner) : 0;
            }
            const std::ptrdiff_t f = block.layout.at(above);
            problem.system.coefficient[b][std::size_t(d)][f] = g[axis] * value;
            block.conductance[std::size_t(d)][f] = g[axis];
          }
    }
  }
  // Over the whole box on every rank, so that the mean is the same number everywhere.
  double mean = 0;
  if (problem.singular) {
    for (int k = 0; k < problem.cells[2]; ++k)
      for (int j = 0; j < problem.cells[1]; ++j)
        for (int i = 0; i < problem.cells[0]; ++i)
          mean += random_of({i, j, k}, seed);
    mean /= double(problem.cells[0]) * problem.cells[1] * problem.cells[2];
  }
  for (std::size_t b = 0; b < mesh.local.size(); ++b) {
    const Layout& layout = mesh.local[b].layout;
    for (int k = 0; k < layout.cells[2]; ++k)
      for (int j = 0; j < layout.cells[1]; ++j)
        for (int i = 0; i < layout.cells[0]; ++i)
          problem.system.rhs[b][layout.at(i, j, k)] =
              random_of(in_box({mesh.local[b].id, {i, j, k}}), seed) - mean;
  }
}

/// The field on the whole box, i fastest, on every rank.
inline std::vector<double> on_box(const PressureProblem& problem, const BlockFields& q) {
  const Index3& n = problem.cells;
  const auto ni = std::size_t(n[0]), nj = std::size_t(n[1]);
  std::vector<double> all(ni * nj * std::size_t(n[2]), 0.0);
  for (std::size_t b = 0; b < problem.mesh.local.size(); ++b) {
    const Layout& layout = problem.mesh.local[b].layout;
    const BlockOrientation& o = problem.orientation[std::size_t(problem.mesh.local[b].id)];
    for (int k = 0; k < layout.cells[2]; ++k)
      for (int j = 0; j < layout.cells[1]; ++j)
        for (int i = 0; i < layout.cells[0]; ++i) {
          const Index3 g = o.in_box({i, j, k});
          all[std::size_t(g[0]) + ni * (std::size_t(g[1]) + nj * std::size_t(g[2]))] =
              q[b][layout.at(i, j, k)];
        }
  }
  MPI_Allreduce(MPI_IN_PLACE, all.data(), int(all.size()), MPI_DOUBLE, MPI_SUM, problem.mesh.comm);
  return all;
}

/// Largest difference of two fields over the largest value of the second.
inline double difference(const std::vector<double>& one, const std::vector<double>& two) {
  double most = 0, size = 0;
  for (std::size_t n = 0; n < one.size(); ++n) {
    if (!(std::abs(one[n] - two[n]) <= most))
      most = std::abs(one[n] - two[n]);
    size = std::max(size, std::abs(two[n]));
  }
  return most / size;
}

// Media: what a gas among particles looks like to the pressure equation.

inline double uniform_medium(const Index3&) {
  return 1;
}

/// Every cell drawn between 1 and `jump`, evenly in the logarithm.
inline Medium random_medium(double jump) {
  return [jump](const Index3& c) { return std::pow(jump, random_of(c, 7)); };
}

/// A bed that fills the lower half, `jump` times less conductive than the gas above, with random
/// packing.
inline Medium bed_medium(double jump, int n) {
  return [jump, n](const Index3& c) { return c[2] < n / 2 ? (0.5 + random_of(c, 5)) / jump : 1; };
}

/// Balls of `inside` times the conductivity around them: clusters (< 1) or bubbles (> 1), eight of
/// them, apart from each other.
inline Medium ball_medium(double inside, int n) {
  return [inside, n](const Index3& c) {
    double squares = 0; // of the distance to the centre of the octant, over n
    for (const int i : c) {
      const double x = (i + 0.5) / n;
      const double from = x - (x < 0.5 ? 0.23 : 0.77);
      squares += from * from;
    }
    return squares < 0.17 * 0.17 ? inside : 1.0;
  };
}

/// Twenty balls at random places, `inside` times as conductive as what is around them: some
/// overlap, some only nearly touch, by an edge or a corner of cells or across a few.
inline Medium touching_medium(double inside, int n) {
  return [inside, n](const Index3& c) {
    for (int ball = 0; ball < 20; ++ball) {
      double squares = 0;
      for (int d = 0; d < 3; ++d) {
        const double from = (c[std::size_t(d)] + 0.5) / n - random_of({ball, d, 0}, 3);
        squares += from * from;
      }
      if (squares < 0.13 * 0.13)
        return inside;
    }
    return 1.0;
  };
}

/// Every cell 1 or `jump`, either as likely.
inline Medium binary_medium(double jump) {
  return [jump](const Index3& c) { return random_of(c, 11) < 0.5 ? 1 : jump; };
}

} // namespace granflux::cfd::testing
