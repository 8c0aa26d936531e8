// SPDX-FileCopyrightText: 2026 The GranFlux developers
// SPDX-License-Identifier: BSD-3-Clause
#include "graph_level.hpp"

#include <algorithm>
#include <array>
#include <atomic>
#include <numeric>
#include <omp.h>
#include <utility>

#include <granflux/cfd/row_sweep.hpp>

#include "cell_groups.hpp"
#include "cell_numbering.hpp"

namespace granflux::cfd {

namespace {

constexpr std::size_t u(int i) {
  return std::size_t(i);
}

/// Where the blocks' shares of an array begin, and its end; `of_block` entries each.
template <class Size> std::vector<int> starts(const Level& level, Size&& of_block) {
  std::vector<int> at{0};
  for (const LevelBlock& block : level.blocks)
    at.push_back(at.back() + int(of_block(block.layout)));
  return at;
}

std::vector<int> position_starts(const Level& level) {
  return starts(level, [](const LevelLayout& layout) { return layout.size; });
}

/// The cells of a level, one after the other through all local blocks.
class CellLine {
public:
  explicit CellLine(const Level& level)
      : level_(level),
        starts_(starts(level, [](const LevelLayout& layout) { return layout.interior(); })) {}

  [[nodiscard]] int count() const { return starts_.back(); }
  [[nodiscard]] int of(std::size_t block, const Index3& cell) const {
    const Index3& n = level_.blocks[block].layout.cells;
    return starts_[block] + cell[0] + n[0] * (cell[1] + n[1] * cell[2]);
  }
  [[nodiscard]] std::pair<std::size_t, Index3> at(int number) const {
    std::size_t block = 0;
    while (number >= starts_[block + 1])
      ++block;
    const Index3& n = level_.blocks[block].layout.cells;
    const int in_block = number - starts_[block];
    return {block, {in_block % n[0], in_block / n[0] % n[1], in_block / n[0] / n[1]}};
  }
  [[nodiscard]] int first_of_block(std::size_t block) const { return starts_[block]; }

private:
  const Level& level_;
  std::vector<int> starts_;
};

/// The cells of a finer level that a coarse cell is made of.
IndexBox cells_of(const Level& fine, const Level& coarse, std::size_t block, const Index3& cell) {
  const auto& pairing = coarse.pairings[u(coarse.mesh.local[block].id)];
  IndexBox box;
  for (std::size_t d = 0; d < 3; ++d) {
    const int n = fine.blocks[block].layout.cells[d];
    box.lo[d] = pairing[d].first(cell[d], n);
    box.hi[d] = pairing[d].first(cell[d] + 1, n);
  }
  return box;
}

/// body(position) for the cells of a box.
template <class Body> void for_box(const LevelLayout& layout, const IndexBox& box, Body&& body) {
  for (int k = box.lo[2]; k < box.hi[2]; ++k)
    for (int j = box.lo[1]; j < box.hi[1]; ++j)
      for (int i = box.lo[0]; i < box.hi[0]; ++i)
        body(layout.at(i, j, k));
}

/// Diagonals and couplings of the cells of a box, in the order of for_box; false where every
/// coupling is at least `least` of both diagonals, which cells then need not be told apart.
bool gather(const LevelBlock& b, const IndexBox& box, double least, CellGroups& groups) {
  const LevelLayout& layout = b.layout;
  const float* inverse = b.inverse_diagonal.data();
  bool weak = false;
  const auto each_link = [&](auto&& body) {
    Index3 size{};
    for (std::size_t d = 0; d < 3; ++d)
      size[d] = box.hi[d] - box.lo[d];
    const Index3 step{1, size[0], size[0] * size[1]};
    int node = 0;
    for_each_in_order(size, [&](const Index3& c) {
      const std::ptrdiff_t at = layout.at(box.lo[0] + c[0], box.lo[1] + c[1], box.lo[2] + c[2]);
      for (std::size_t d = 0; d < 3; ++d)
        if (c[d] > 0)
          body(node - step[d], node, b.coefficient[d].data()[at], at, at - layout.stride[d]);
      ++node;
    });
  };
  each_link([&](int, int, float c, std::ptrdiff_t one, std::ptrdiff_t other) {
    weak = weak || double(c) * double(std::min(inverse[one], inverse[other])) < least;
  });
  if (!weak)
    return false;
  int nodes = 0;
  for_box(layout, box, [&](std::ptrdiff_t) { ++nodes; });
  groups.start(nodes);
  nodes = 0;
  for_box(layout, box, [&](std::ptrdiff_t at) {
    groups.set_diagonal(nodes++, inverse[at] > 0 ? 1 / double(inverse[at]) : 0);
  });
  each_link([&](int below, int above, float c, std::ptrdiff_t, std::ptrdiff_t) {
    groups.add_coupling(below, above, double(c));
  });
  return true;
}

/// Whether a coupling between two cells of this coarse row that will join is below `least` of a
/// diagonal.
bool has_weak_coupling(const LevelBlock& b, const std::array<Pairing, 3>& pairing, int J, int K,
                       float least) {
  const LevelLayout& layout = b.layout;
  const auto [ni, nj, nk] = layout.cells;
  const float* inverse = b.inverse_diagonal.data();
  int weak = 0;
  const auto across = [&](std::size_t d, std::ptrdiff_t row) {
    const float *c = b.coefficient[d].data() + row, *here = inverse + row,
                *below = here - layout.stride[d];
#pragma omp simd reduction(+ : weak)
    for (int i = 0; i < ni; ++i)
      weak += c[i] * std::min(here[i], below[i]) < least ? 1 : 0;
  };
  const int j_first = pairing[1].first(J, nj), k_first = pairing[2].first(K, nk);
  for (int k = k_first; k < pairing[2].first(K + 1, nk); ++k)
    for (int j = j_first; j < pairing[1].first(J + 1, nj); ++j) {
      const std::ptrdiff_t row = layout.at(0, j, k);
      if (j > j_first)
        across(1, row);
      if (k > k_first)
        across(2, row);
      if (!pairing[0].pairs)
        continue;
      const int shift = pairing[0].shift, end_whole = (ni + shift) / 2;
      const float *c = b.coefficient[0].data() + row - shift, *at = inverse + row - shift;
#pragma omp simd reduction(+ : weak)
      for (int I = shift; I < end_whole; ++I)
        weak += c[2 * I + 1] * std::min(at[2 * I], at[2 * I + 1]) < least ? 1 : 0;
    }
  return weak > 0;
}

/// A side of a coarse cell.
struct CellSide {
  float share;          ///< of a coupling that is left when the distance has grown
  int direction_beyond; ///< of the cell beyond, in its block
};

std::array<CellSide, 6> sides_of(const Level& fine, const Level& coarse, std::size_t block,
                                 const Index3& cell) {
  const auto& pairing = coarse.pairings[u(coarse.mesh.local[block].id)];
  const Index3 &n = fine.blocks[block].layout.cells, &N = coarse.blocks[block].layout.cells;
  std::array<CellSide, 6> sides{};
  for (int side = 0; side < 6; ++side) {
    const int d = side / 2, high = side % 2, next = cell[u(d)] + (high ? 1 : -1);
    const int width = pairing[u(d)].width(cell[u(d)], n[u(d)]);
    double share = 0;
    int beyond = d;
    if (next >= 0 && next < N[u(d)])
      share = over_distance(width, pairing[u(d)].width(next, n[u(d)]));
    else {
      share = 1.0 / width;
      Index3 face = cell;
      face[u(d)] += high;
      for (const LinkFactor& link : coarse.link_factors)
        if (link.block == block && link.direction == d && link.faces.contains(face))
          share *= double(link.factor), beyond = link.direction_beyond;
    }
    sides[u(side)] = {float(share), beyond};
  }
  return sides;
}

/// The cells of a structured level, by their positions in its fields, block after block.
struct CellSource {
  CellSource(const Level& f, Level& c, const Level& place)
      : fine(f), cells(c), coarse(place), start(position_starts(f)) {}

  [[nodiscard]] std::size_t size() const { return u(start.back()); }

  /// The nodes in a coarse cell.
  void list(std::size_t b, const Index3& cell, std::vector<int>& nodes) const {
    nodes.clear();
    for_box(fine.blocks[b].layout, cells_of(fine, coarse, b, cell),
            [&](std::ptrdiff_t at) { nodes.push_back(start[b] + int(at)); });
  }
  /// Their couplings; false where they need not be told apart.
  bool meet(std::size_t b, const Index3& cell, double least, const std::vector<int>&,
            CellGroups& groups) const {
    return gather(fine.blocks[b], cells_of(fine, coarse, b, cell), least, groups);
  }
  template <class Body> void for_edges(std::size_t b, int node, Body&& body) const {
    const LevelBlock& block = fine.blocks[b];
    const std::ptrdiff_t at = node - start[b];
    for (std::size_t d = 0; d < 3; ++d) {
      const std::ptrdiff_t stride = block.layout.stride[d];
      const float* c = block.coefficient[d].data() + at;
      body(node - int(stride), std::uint8_t(2 * d), c[0]);
      body(node + int(stride), std::uint8_t(2 * d + 1), c[stride]);
    }
  }
  /// Fills `joined` behind links; returns the positions of other ranks' cells with what they join.
  std::vector<std::pair<int, RemoteNode>> across_links(std::vector<int>& joined) const {
    for (std::size_t b = 0; b < cells.blocks.size(); ++b) {
      float* x = cells.blocks[b].x.data(); // whole numbers: exact in single precision up to 2^24
      const int* from = joined.data() + start[b];
      for (std::size_t at = 0; at < cells.blocks[b].layout.size; ++at)
        x[at] = float(from[at]);
    }
    cells.exchange(&LevelBlock::x);
    for (std::size_t b = 0; b < cells.blocks.size(); ++b) {
      float* x = cells.blocks[b].x.data();
      int* to = joined.data() + start[b];
      for (std::size_t at = 0; at < cells.blocks[b].layout.size; ++at) {
        to[at] = int(x[at]);
        x[at] = 0; // padding and ghosts stay 0
      }
    }
    std::vector<std::pair<int, RemoteNode>> remote;
    int rank = 0;
    MPI_Comm_rank(fine.mesh.comm, &rank);
    for (std::size_t b = 0; b < fine.blocks.size(); ++b)
      for (const Patch& patch : fine.mesh.blocks[u(fine.mesh.local[b].id)].patches) {
        const int owner = patch.link ? fine.mesh.blocks[u(patch.link->block)].rank : rank;
        if (owner == rank)
          continue;
        const LevelLayout& layout = fine.blocks[b].layout;
        const std::ptrdiff_t stride = layout.stride[u(patch.side.direction)];
        for_box(layout, patch.cells, [&](std::ptrdiff_t at) {
          const int ghost = start[b] + int(at + (patch.side.high ? stride : -stride));
          remote.push_back({ghost, {owner, joined[u(ghost)]}});
        });
      }
    return remote;
  }

  const Level& fine;
  Level& cells;
  const Level& coarse;
  std::vector<int> start;
};

/// The nodes of a level that is split.
struct NodeSource {
  NodeSource(const GraphLevel& f, const Level& place)
      : graph(f), fine(f.place), coarse(place), line(fine) {}

  [[nodiscard]] std::size_t size() const { return graph.x.size(); }

  void list(std::size_t b, const Index3& cell, std::vector<int>& nodes) const {
    const IndexBox box = cells_of(fine, coarse, b, cell);
    nodes.clear();
    for (int k = box.lo[2]; k < box.hi[2]; ++k)
      for (int j = box.lo[1]; j < box.hi[1]; ++j)
        for (int i = box.lo[0]; i < box.hi[0]; ++i) {
          const auto c = u(line.of(b, {i, j, k}));
          for (int node = graph.first_of_cell[c]; node < graph.first_of_cell[c + 1]; ++node)
            nodes.push_back(node);
        }
  }
  bool meet(std::size_t b, const Index3&, double, const std::vector<int>& nodes,
            CellGroups& groups) const {
    groups.start(int(nodes.size()));
    for (std::size_t a = 0; a < nodes.size(); ++a) {
      const float inverse = graph.inverse_diagonal[u(nodes[a])];
      groups.set_diagonal(int(a), inverse > 0 ? 1 / double(inverse) : 0);
      for_edges(b, nodes[a], [&](int other, std::uint8_t side, float c) {
        if (side < GraphLevel::within ? side % 2 == 0 : other < nodes[a])
          return; // seen from the other end
        const auto there = std::find(nodes.begin(), nodes.end(), other);
        if (there != nodes.end() && other != nodes[a])
          groups.add_coupling(int(a), int(there - nodes.begin()), double(c));
      });
    }
    return true;
  }
  template <class Body> void for_edges(std::size_t, int node, Body&& body) const {
    for (int e = graph.row[u(node)]; e < graph.row[u(node) + 1]; ++e)
      body(graph.neighbour[u(e)], graph.side[u(e)], graph.coupling[u(e)]);
  }
  std::vector<std::pair<int, RemoteNode>> across_links(std::vector<int>& joined) const {
    graph.halo.exchange(joined);
    std::vector<std::pair<int, RemoteNode>> remote;
    int ghost = graph.own;
    for (const RemoteNode& of : graph.halo.ghosts()) {
      remote.push_back({ghost, {of.rank, joined[u(ghost)]}});
      ++ghost;
    }
    return remote;
  }

  const GraphLevel& graph;
  const Level &fine, &coarse;
  CellLine line;
};

struct Edge {
  int neighbour;
  std::uint8_t side;
  double coupling;
};

} // namespace

template <class Source> void GraphLevel::join(const Source& source, double least) {
  const CellLine line(place);
  const int cells = line.count();
  joined.assign(source.size(), -1);
  first_of_cell.assign(u(cells) + 1, 0);
  std::vector<int> members_of_cell(u(cells) + 1, 0);

  // Which nodes stay together: their group's number in the cell, for now.
  const bool parallel = cells >= smallest_parallel_sweep;
  in_team(parallel, [&] {
    std::vector<int> nodes;
    CellGroups groups;
#pragma omp for schedule(static) nowait
    for (int c = 0; c < cells; ++c) {
      const auto [b, cell] = line.at(c);
      source.list(b, cell, nodes);
      const bool apart = source.meet(b, cell, least, nodes, groups);
      first_of_cell[u(c) + 1] = apart ? groups.join(least) : 1;
      members_of_cell[u(c) + 1] = int(nodes.size());
      for (std::size_t a = 0; a < nodes.size(); ++a)
        joined[u(nodes[a])] = apart ? groups.of(int(a)) : 0;
    }
  });
  std::partial_sum(first_of_cell.begin(), first_of_cell.end(), first_of_cell.begin());
  std::partial_sum(members_of_cell.begin(), members_of_cell.end(), members_of_cell.begin());
  own = first_of_cell.back();
  first_member.assign(u(own) + 1, members_of_cell.back());
  member.resize(u(members_of_cell.back()));
  in_team(parallel, [&] {
    std::vector<int> nodes;
#pragma omp for schedule(static) nowait
    for (int c = 0; c < cells; ++c) {
      const auto [b, cell] = line.at(c);
      source.list(b, cell, nodes);
      int at = members_of_cell[u(c)];
      for (int group = 0; group < first_of_cell[u(c) + 1] - first_of_cell[u(c)]; ++group) {
        first_member[u(first_of_cell[u(c)] + group)] = at;
        for (const int node : nodes)
          if (joined[u(node)] == group)
            member[u(at++)] = node;
      }
      for (const int node : nodes)
        joined[u(node)] += first_of_cell[u(c)];
    }
  });

  // Neighbours on other ranks.
  const auto remote = source.across_links(joined);
  std::vector<RemoteNode> ghosts;
  for (const auto& [at, node] : remote)
    ghosts.push_back(node);
  std::sort(ghosts.begin(), ghosts.end());
  ghosts.erase(std::unique(ghosts.begin(), ghosts.end()), ghosts.end());
  for (const auto& [at, node] : remote)
    joined[u(at)] =
        own + int(std::lower_bound(ghosts.begin(), ghosts.end(), node) - ghosts.begin());
  const int nowhere = own + int(ghosts.size());
  std::replace(joined.begin(), joined.end(), -1, nowhere);
  halo = GraphHalo(place.mesh.comm, own, std::move(ghosts));
  rhs.assign(u(own), 0.0F);
  x.assign(u(nowhere) + 1, 0.0F);
  spare.assign(x.size(), 0.0F);

  // Couplings: sums over the finer ones, as far as what is coupled lies apart.
  struct Rows {
    std::vector<Edge> edges;
    std::vector<int> ends;
  };
  std::vector<Rows> parts(u(parallel ? omp_get_max_threads() : 1));
  std::array<std::vector<float>, 3> resistance; ///< between the halves of a node; 0 where undivided
  for (std::vector<float>& along : resistance)
    along.assign(x.size(), 0.0F);
  in_team(parallel, [&] {
    const int threads = omp_get_num_threads(), thread = omp_get_thread_num();
    Rows& rows = parts[u(thread)];
    const int end = int(long(cells) * (thread + 1) / threads);
    for (int c = int(long(cells) * thread / threads); c < end; ++c) {
      const std::size_t b = line.at(c).first;
      const int first = first_of_cell[u(c)], last = first_of_cell[u(c) + 1];
      for (int node = first; node < last; ++node) {
        const std::size_t begin = rows.edges.size();
        std::array<double, 3> inside{};
        for (int m = first_member[u(node)]; m < first_member[u(node) + 1]; ++m)
          source.for_edges(b, member[u(m)], [&](int other, std::uint8_t over, float coupled) {
            if (coupled == 0)
              return;
            const int neighbour_node = joined[u(other)];
            if (neighbour_node == node) {
              if (over < within && over % 2 == 1)
                inside[over / 2] += double(coupled);
              return;
            }
            const bool here = neighbour_node >= first && neighbour_node < last;
            const std::uint8_t where = here ? within : over;
            for (std::size_t e = begin; e < rows.edges.size(); ++e)
              if (rows.edges[e].neighbour == neighbour_node && rows.edges[e].side == where) {
                rows.edges[e].coupling += double(coupled);
                return;
              }
            rows.edges.push_back({neighbour_node, where, double(coupled)});
          });
        rows.ends.push_back(int(rows.edges.size()));
        for (std::size_t d = 0; d < 3; ++d)
          resistance[d][u(node)] = inside[d] > 0 ? float(1 / inside[d]) : 0.0F;
      }
    }
  });
  row.assign(1, 0);
  for (const Rows& rows : parts) {
    const int before = row.back();
    for (const int end : rows.ends)
      row.push_back(before + end);
  }
  const auto edges = u(row.back());
  neighbour.resize(edges);
  coupling.resize(edges);
  side.resize(edges);
  inverse_diagonal.resize(u(own));
  std::size_t at = 0;
  for (const Rows& rows : parts)
    for (const Edge& edge : rows.edges) {
      neighbour[at] = edge.neighbour;
      coupling[at] = float(edge.coupling);
      side[at++] = edge.side;
    }
  for (std::vector<float>& along : resistance)
    halo.exchange(along);

  // Over the distance that has grown, where the way through both nodes is as resistive as between
  // them, but no less than on a structured level.
  deal(parallel, cells, [&](std::ptrdiff_t n) {
    const int c = int(n);
    const auto [b, cell] = line.at(c);
    const std::array<CellSide, 6> sides = sides_of(source.fine, place, b, cell);
    for (int node = first_of_cell[u(c)]; node < first_of_cell[u(c) + 1]; ++node) {
      double diagonal = 0;
      for (int e = row[u(node)]; e < row[u(node) + 1]; ++e) {
        float& k = coupling[u(e)];
        if (side[u(e)] < within) {
          const auto& [share, beyond] = sides[side[u(e)]];
          const float way =
              resistance[side[u(e)] / 2U][u(node)] + resistance[u(beyond)][u(neighbour[u(e)])];
          k *= std::max(share, 1 / (1 + 0.5F * k * way));
        }
        diagonal += double(k);
      }
      inverse_diagonal[u(node)] = diagonal > 0 ? float(1 / diagonal) : 0.0F;
    }
  });
  total = own;
  MPI_Allreduce(MPI_IN_PLACE, &total, 1, MPI_LONG, MPI_SUM, place.mesh.comm);
}

GraphLevel::GraphLevel(const Level& fine, Level& cells, const Level& coarse, double least)
    : place(coarse) {
  join(CellSource(fine, cells, coarse), least);
}

GraphLevel::GraphLevel(const GraphLevel& fine, const Level& coarse, double least) : place(coarse) {
  join(NodeSource(fine, coarse), least);
}

float GraphLevel::left_over(std::ptrdiff_t i, const std::vector<float>& of) const {
  const auto n = std::size_t(i);
  float image = 0;
  for (int e = row[n]; e < row[n + 1]; ++e)
    image += coupling[u(e)] * (of[n] - of[u(neighbour[u(e)])]);
  return rhs[n] - image;
}

void GraphLevel::smooth(Start start) {
  const Smoothing& steps = place.smoothing;
  const bool from_zero = start == Start::zero;
  if (from_zero) {
    const float gain = steps.steps[1].gain;
    deal(own >= smallest_parallel_sweep, own, [&](std::ptrdiff_t i) {
      x[std::size_t(i)] = gain * inverse_diagonal[std::size_t(i)] * rhs[std::size_t(i)];
    });
  }
  const int first = from_zero ? 2 : 1;
  for (int n = first; n <= steps.count(); ++n) {
    halo.exchange(x);
    const auto [keep, gain] = steps.steps[u(n)];
    const float keep_before = n > first ? keep : 0.0F;
    deal(own >= smallest_parallel_sweep, own, [&, keep = keep, gain = gain](std::ptrdiff_t node) {
      const auto i = std::size_t(node);
      spare[i] = (1 + keep) * x[i] + gain * inverse_diagonal[i] * left_over(node, x) -
                 keep_before * spare[i];
    });
    std::swap(x, spare);
  }
}

void GraphLevel::restrict_from(const Level& cells) {
  const std::vector<int> position = position_starts(cells);
  const CellLine line(place);
  for (std::size_t b = 0; b < cells.blocks.size(); ++b) {
    const float* residual = cells.blocks[b].rhs.data();
    const int begin = first_of_cell[u(line.first_of_block(b))],
              end = first_of_cell[u(line.first_of_block(b + 1))], origin = position[b];
    deal(end - begin >= smallest_parallel_sweep, end - begin, [&](std::ptrdiff_t n) {
      const auto i = u(begin) + std::size_t(n);
      float sum = 0;
      for (int m = first_member[i]; m < first_member[i + 1]; ++m)
        sum += residual[member[u(m)] - origin];
      rhs[i] = sum;
    });
  }
}

void GraphLevel::restrict_from(GraphLevel& fine) {
  fine.halo.exchange(fine.x);
  deal(fine.own >= smallest_parallel_sweep, fine.own,
       [&](std::ptrdiff_t i) { fine.spare[std::size_t(i)] = fine.left_over(i, fine.x); });
  deal(own >= smallest_parallel_sweep, own, [&](std::ptrdiff_t node) {
    const auto i = std::size_t(node);
    float sum = 0;
    for (int m = first_member[i]; m < first_member[i + 1]; ++m)
      sum += fine.spare[u(member[u(m)])];
    rhs[i] = sum;
  });
}

void GraphLevel::correct(Level& cells) const {
  const std::vector<int> position = position_starts(cells);
  for (std::size_t b = 0; b < cells.blocks.size(); ++b) {
    LevelBlock& block = cells.blocks[b];
    const int* node = joined.data() + position[b];
    for_rows(block.layout, [&](std::ptrdiff_t first, int, int) {
      float* to = block.x.data();
      for (std::ptrdiff_t c = first; c < first + block.layout.cells[0]; ++c)
        to[c] = x[u(node[c])];
    });
  }
}

void GraphLevel::correct(GraphLevel& fine) const {
  deal(fine.own >= smallest_parallel_sweep, fine.own,
       [&](std::ptrdiff_t i) { fine.x[std::size_t(i)] += x[u(joined[std::size_t(i)])]; });
}

long badly_joined(const Level& fine, const Level& coarse, double least) {
  std::atomic<long> bad = 0;
  for (std::size_t b = 0; b < fine.blocks.size(); ++b) {
    const LevelBlock& block = fine.blocks[b];
    const Index3& N = coarse.blocks[b].layout.cells;
    const auto& pairing = coarse.pairings[u(coarse.mesh.local[b].id)];
    in_team(worth_a_team(block.layout), [&] {
      CellGroups groups;
#pragma omp for collapse(2) schedule(static) nowait
      for (int K = 0; K < N[2]; ++K)
        for (int J = 0; J < N[1]; ++J) {
          if (!has_weak_coupling(block, pairing, J, K, float(least)))
            continue;
          for (int I = 0; I < N[0]; ++I)
            if (gather(block, cells_of(fine, coarse, b, {I, J, K}), least, groups) &&
                groups.join(least) > 1)
              ++bad;
        }
    });
  }
  return bad;
}

} // namespace granflux::cfd
