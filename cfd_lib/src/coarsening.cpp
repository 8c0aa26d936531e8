// SPDX-FileCopyrightText: 2026 The GranFlux developers
// SPDX-License-Identifier: BSD-3-Clause
#include <granflux/cfd/coarsening.hpp>

#include <cmath>
#include <numeric>

#include <granflux/cfd/sweep.hpp>

namespace granflux::cfd {

namespace {

constexpr std::size_t u(int i) {
  return std::size_t(i);
}

/// (Block, direction) pairs that must coarsen together, as links carry a direction from block to
/// block along their common side, and the shift with which each pairs its cells.
class Sheets {
public:
  explicit Sheets(const Mesh& mesh)
      : parent_(3 * mesh.blocks.size()), parity_(parent_.size(), 0), required_(parent_.size(), -1),
        blocked_(parent_.size(), false) {
    std::iota(parent_.begin(), parent_.end(), 0);
    for (int id = 0; id < int(mesh.blocks.size()); ++id)
      for (const Patch& patch : mesh.blocks[u(id)].patches)
        if (patch.link)
          tie_sides(id, *patch.link, patch.side.direction);
    for (int id = 0; id < int(mesh.blocks.size()); ++id)
      for (const Patch& patch : mesh.blocks[u(id)].patches)
        if (patch.link)
          keep_edges(id, mesh.blocks[u(id)].cells, patch);
  }

  int of(int block, int d) { return find(3 * block + d).first; }
  bool blocked(int block, int d) { return blocked_[u(of(block, d))]; }
  int shift(int block, int d) {
    const auto [root, parity] = find(3 * block + d);
    return (std::max(required_[u(root)], 0) + parity) % 2;
  }

private:
  /// Root and parity of the shift relative to the root's.
  std::pair<int, int> find(int n) {
    int parity = 0;
    while (parent_[u(n)] != n) {
      parity ^= parity_[u(n)];
      n = parent_[u(n)];
    }
    return {n, parity};
  }

  void tie_sides(int id, const Link& link, int normal) {
    for (int d = 0; d < 3; ++d) {
      const int axis = link.axis[u(d)];
      if (axis == normal)
        continue;
      // Cell c is donor offset + sign c: where the order turns, pairs turn with it.
      const int turned = link.sign[u(d)] < 0 ? 1 : 0;
      const int differ = std::abs(link.offset[u(d)] + turned) % 2;
      const auto [a, parity_a] = find(3 * id + axis);
      const auto [b, parity_b] = find(3 * link.block + d);
      const int between = (parity_a + parity_b + differ) % 2;
      if (a == b)
        blocked_[u(a)] = blocked_[u(a)] || between != 0;
      else {
        parent_[u(b)] = a;
        parity_[u(b)] = between;
        blocked_[u(a)] = blocked_[u(a)] || blocked_[u(b)];
      }
    }
  }

  /// No pair may lie across the edge of a patch that is a link.
  void keep_edges(int id, const Index3& cells, const Patch& patch) {
    for (int d = 0; d < 3; ++d) {
      if (d == patch.side.direction)
        continue;
      for (const int edge : {patch.cells.lo[u(d)], patch.cells.hi[u(d)]}) {
        if (edge == 0 || edge == cells[u(d)])
          continue;
        const auto [root, parity] = find(3 * id + d);
        const int wanted = (edge + parity) % 2;
        if (required_[u(root)] >= 0 && required_[u(root)] != wanted)
          blocked_[u(root)] = true;
        required_[u(root)] = wanted;
      }
    }
  }

  std::vector<int> parent_, parity_, required_;
  std::vector<bool> blocked_;
};

/// Sum over the faces of a direction of one block, and their number.
std::array<double, 2> conductance_of(const Block& block, int d) {
  std::array<double, 2> sum{0, 0};
  Index3 n = block.layout.cells;
  ++n[u(d)];
  for (int k = 0; k < n[2]; ++k)
    for (int j = 0; j < n[1]; ++j)
      for (int i = 0; i < n[0]; ++i) {
        sum[0] += std::abs(block.conductance[u(d)][block.layout.at(i, j, k)]);
        sum[1] += 1;
      }
  return sum;
}

} // namespace

Coarsening::Coarsening(const Mesh& finest) : by_axis_(finest.lattice.has_value()) {
  std::vector<double> sums(6 * finest.blocks.size(), 0.0);
  for (const Block& block : finest.local)
    for (int d = 0; d < 3; ++d) {
      const auto [sum, faces] = conductance_of(block, d);
      sums[u(6 * block.id + 2 * d)] = sum;
      sums[u(6 * block.id + 2 * d + 1)] = faces;
    }
  MPI_Allreduce(MPI_IN_PLACE, sums.data(), int(sums.size()), MPI_DOUBLE, MPI_SUM, finest.comm);

  Sheets sheets(finest);
  const auto group = [&](int id, int d) { return u(by_axis_ ? d : sheets.of(id, d)); };
  std::vector<double> total(sums.size() / 2, 0.0), faces(sums.size() / 2, 0.0);
  for (int id = 0; id < int(finest.blocks.size()); ++id)
    for (int d = 0; d < 3; ++d) {
      total[group(id, d)] += sums[u(6 * id + 2 * d)];
      faces[group(id, d)] += sums[u(6 * id + 2 * d + 1)];
    }
  strength_.resize(finest.blocks.size());
  for (int id = 0; id < int(finest.blocks.size()); ++id)
    for (int d = 0; d < 3; ++d)
      strength_[u(id)][u(d)] = total[group(id, d)] / faces[group(id, d)];
}

Pairings Coarsening::next(const Mesh& mesh) {
  // A direction joins the strongest one if its coupling is at least this share of it: that keeps
  // the ratio of couplings below 1/share, where point smoothing still works.
  constexpr double share = 0.25;
  const int blocks = int(mesh.blocks.size());
  Sheets sheets(mesh);
  const auto group = [&](int id, int d) { return u(by_axis_ ? d : sheets.of(id, d)); };

  std::vector<char> possible(u(3 * blocks), 0), unwanted(u(3 * blocks), 0),
      wanted(u(3 * blocks), 0);
  for (int id = 0; id < blocks; ++id)
    for (int d = 0; d < 3; ++d) {
      const int n = mesh.blocks[u(id)].cells[u(d)];
      if (Pairing{true, sheets.shift(id, d)}.coarse(n - 1) + 1 < n)
        possible[group(id, d)] = 1;
    }
  for (int id = 0; id < blocks; ++id)
    for (int d = 0; d < 3; ++d)
      if (sheets.blocked(id, d))
        possible[group(id, d)] = 0;
  for (int id = 0; id < blocks; ++id) {
    double strongest = 0;
    for (int d = 0; d < 3; ++d)
      if (possible[group(id, d)])
        strongest = std::max(strongest, strength_[u(id)][u(d)]);
    for (int d = 0; d < 3; ++d) {
      const bool strong = strength_[u(id)][u(d)] >= share * strongest;
      (strong ? wanted : unwanted)[group(id, d)] = 1;
    }
  }
  // Where blocks disagree everywhere, coarsening what only some want beats not coarsening.
  bool agreed = false;
  for (std::size_t g = 0; g < possible.size(); ++g)
    agreed = agreed || (possible[g] && wanted[g] && !unwanted[g]);

  Pairings pairings(u(blocks));
  for (int id = 0; id < blocks; ++id) {
    for (int d = 0; d < 3; ++d) {
      const std::size_t g = group(id, d);
      if (possible[g] && wanted[g] && (!agreed || !unwanted[g]))
        pairings[u(id)][u(d)] = {true, sheets.shift(id, d)};
    }
    // Twice the distance halves a coupling, twice the area doubles it.
    for (int d = 0; d < 3; ++d)
      for (int e = 0; e < 3; ++e)
        if (pairings[u(id)][u(d)].pairs)
          strength_[u(id)][u(e)] *= d == e ? 0.5 : 2;
  }
  return pairings;
}

bool closed_on_itself(const Mesh& mesh, int id, int direction) {
  const BlockInfo& info = mesh.blocks[u(id)];
  if (info.cells[u(direction)] > 1)
    return false;
  return std::any_of(info.patches.begin(), info.patches.end(), [&](const Patch& patch) {
    return patch.side.direction == direction && patch.link && patch.link->block == id;
  });
}

Mesh join_cells(const Mesh& mesh, const Pairings& pairings) {
  Mesh coarse;
  coarse.comm = mesh.comm;
  for (std::size_t id = 0; id < mesh.blocks.size(); ++id) {
    const BlockInfo& fine = mesh.blocks[id];
    const auto& pairing = pairings[id];
    BlockInfo info;
    info.rank = fine.rank;
    for (std::size_t d = 0; d < 3; ++d)
      info.cells[d] = pairing[d].coarse(fine.cells[d] - 1) + 1;
    for (const Patch& patch : fine.patches) {
      if (!patch.link)
        continue;
      const auto normal = u(patch.side.direction);
      Patch joined{patch.side, {}, -1, *patch.link};
      for (std::size_t d = 0; d < 3; ++d) {
        joined.cells.lo[d] = pairing[d].coarse(patch.cells.lo[d]);
        joined.cells.hi[d] = pairing[d].coarse(patch.cells.hi[d] - 1) + 1;
      }
      // One ghost cell and its donor fix the coarse link.
      Index3 ghost = patch.cells.lo, coarse_ghost = joined.cells.lo;
      ghost[normal] = patch.side.high ? fine.cells[normal] : -1;
      coarse_ghost[normal] = patch.side.high ? info.cells[normal] : -1;
      const Index3 donor = patch.link->donor(ghost);
      for (std::size_t d = 0; d < 3; ++d)
        joined.link->offset[d] = pairings[u(patch.link->block)][d].coarse(donor[d]) -
                                 patch.link->sign[d] * coarse_ghost[u(patch.link->axis[d])];
      info.patches.push_back(joined);
    }
    coarse.blocks.push_back(std::move(info));
  }
  for (const Block& block : mesh.local) {
    Block joined;
    joined.id = block.id;
    joined.layout = Layout(coarse.blocks[u(block.id)].cells);
    coarse.local.push_back(std::move(joined));
  }
  return coarse;
}

} // namespace granflux::cfd
