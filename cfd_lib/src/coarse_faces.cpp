// SPDX-FileCopyrightText: 2026 The GranFlux developers
// SPDX-License-Identifier: BSD-3-Clause

// Coefficients of a coarse level from those of the finer one.

#include "multigrid_level.hpp"

#include <algorithm>

#include <granflux/cfd/row_sweep.hpp>

namespace granflux::cfd {

namespace {

constexpr std::size_t u(int i) {
  return std::size_t(i);
}

/// sum[I] += the fine faces that coarse face I of a row is made of, d the direction normal to the
/// row's faces: every one where they lie side by side in the row, the one between coarse cells
/// where the row runs across them.
void add_faces(const float* fine, int n, const Pairing& pairing, bool across, float* sum, int N) {
  if (!pairing.pairs) {
    for (int I = 0; I < N + across; ++I)
      sum[I] += fine[I];
    return;
  }
  if (across) {
    for (int I = 0; I < N + 1; ++I)
      sum[I] += fine[pairing.first(I, n)];
    return;
  }
  const int first_whole = pairing.shift, end_whole = (n + pairing.shift) / 2;
  const float* pair = fine - pairing.shift;
#pragma omp simd
  for (int I = first_whole; I < end_whole; ++I)
    sum[I] += pair[2 * I] + pair[2 * I + 1];
  if (first_whole == 1)
    sum[0] += fine[0];
  if (end_whole < N)
    sum[N - 1] += fine[n - 1];
}

/// Coarse face coefficients of one block and direction from fine ones.
void join_faces(const LevelBlock& fine, const std::array<Pairing, 3>& pairing, int d,
                LevelBlock& coarse) {
  const LevelLayout &from = fine.layout, &to = coarse.layout;
  const float* c = fine.coefficient[u(d)].data();
  float* joined = coarse.coefficient[u(d)].data();
  Index3 faces = to.cells;
  ++faces[u(d)];
  // Fine cells that make a coarse one; along d the one face between coarse cells.
  const auto range = [&](int e, int I) {
    const int n = from.cells[u(e)], first = pairing[u(e)].first(I, n);
    return std::array<int, 2>{first, e == d ? first + 1 : pairing[u(e)].first(I + 1, n)};
  };
  const auto factor = [&](int I) {
    const int n = from.cells[u(d)];
    const int below = I > 0 ? pairing[u(d)].width(I - 1, n) : 0;
    const int above = I < to.cells[u(d)] ? pairing[u(d)].width(I, n) : 0;
    return float(below == 0 ? 1.0 / above : above == 0 ? 1.0 / below : over_distance(below, above));
  };
  deal(worth_a_team(from), faces[1], faces[2], [&](int J, int K) {
    const auto [k_first, k_end] = range(2, K);
    const auto [j_first, j_end] = range(1, J);
    float* row = joined + to.at(0, J, K);
    std::fill(row, row + faces[0], 0.0F);
    for (int k = k_first; k < k_end; ++k)
      for (int j = j_first; j < j_end; ++j)
        add_faces(c + from.at(0, j, k), from.cells[0], pairing[0], d == 0, row, to.cells[0]);
    for (int I = 0; I < faces[0]; ++I)
      row[I] *= factor(d == 0 ? I : d == 1 ? J : K);
  });
}

void invert_diagonal(LevelBlock& b) {
  const LevelLayout& layout = b.layout;
  const auto [si, sj, sk] = layout.stride;
  const float *ci = b.coefficient[0].data(), *cj = b.coefficient[1].data(),
              *ck = b.coefficient[2].data();
  float* inverse = b.inverse_diagonal.data();
  for_rows(layout, [=, n = layout.cells[0], sj = sj, sk = sk](std::ptrdiff_t row, int, int) {
#pragma omp simd
    for (std::ptrdiff_t c = row; c < row + n; ++c) {
      const float diagonal = ci[c] + ci[c + 1] + cj[c] + cj[c + sj] + ck[c] + ck[c + sk];
      // A whole closed region may have become one cell: its correction is 0.
      inverse[c] = diagonal > 0 ? 1 / diagonal : 0;
    }
  });
}

} // namespace

/// Faces of coarse link patches, with the widths of the cells on both sides.
std::vector<LinkFactor> link_factors(const Mesh& fine, const Mesh& coarse,
                                     const Pairings& pairings) {
  std::vector<LinkFactor> factors;
  for (std::size_t b = 0; b < coarse.local.size(); ++b) {
    const int id = coarse.local[b].id;
    const auto width = [&](int block, int d, bool high) {
      const int n = fine.blocks[u(block)].cells[u(d)], N = coarse.blocks[u(block)].cells[u(d)];
      return pairings[u(block)][u(d)].width(high ? N - 1 : 0, n);
    };
    for (const Patch& patch : coarse.blocks[u(id)].patches) {
      const int d = patch.side.direction;
      // The donor's axis that runs on across the side, and the side it is met on.
      const Link& link = *patch.link;
      int across = 0;
      while (link.axis[u(across)] != d)
        ++across;
      const bool donor_high = (link.sign[u(across)] > 0) != patch.side.high;
      const int own = width(id, d, patch.side.high), beyond = width(link.block, across, donor_high);
      IndexBox faces = patch.cells;
      if (patch.side.high)
        ++faces.lo[u(d)], ++faces.hi[u(d)];
      factors.push_back({b, d, faces, float(own * over_distance(own, beyond)), across});
    }
  }
  return factors;
}

void join_level(const Level& fine, Level& coarse) {
  for (std::size_t b = 0; b < fine.blocks.size(); ++b) {
    const int id = fine.mesh.local[b].id;
    for (int d = 0; d < 3; ++d)
      if (!closed_on_itself(coarse.mesh, id, d))
        join_faces(fine.blocks[b], coarse.pairings[u(id)], d, coarse.blocks[b]);
  }
  for (const LinkFactor& link : coarse.link_factors) {
    const LevelLayout& layout = coarse.blocks[link.block].layout;
    float* joined = coarse.blocks[link.block].coefficient[u(link.direction)].data();
    for (int k = link.faces.lo[2]; k < link.faces.hi[2]; ++k)
      for (int j = link.faces.lo[1]; j < link.faces.hi[1]; ++j)
        for (int i = link.faces.lo[0]; i < link.faces.hi[0]; ++i)
          joined[layout.at(i, j, k)] *= link.factor;
  }
  for (LevelBlock& block : coarse.blocks)
    invert_diagonal(block);
}

} // namespace granflux::cfd
