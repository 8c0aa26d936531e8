// SPDX-FileCopyrightText: 2026 The GranFlux developers
// SPDX-License-Identifier: BSD-3-Clause
#include <granflux/coupling/block_locate.hpp>

#include <algorithm>
#include <cmath>
#include <limits>

#include <granflux/cfd/error.hpp>

namespace granflux::coupling {

using cfd::Index3;

namespace {

/// In units of a cell: how far outside a point may seem by rounding.
constexpr double rounding = 1e-9;
/// The same of the planes of faces, which are in single precision.
constexpr double plane_rounding = 1e-5;

/// Low and high corner of a box.
struct Box {
  Vec3 low, high;
};

Box nothing() {
  constexpr double far = std::numeric_limits<double>::infinity();
  return {{far, far, far}, {-far, -far, -far}};
}

void include(Box& box, const Vec3& x) {
  for (int d = 0; d < 3; ++d) {
    box.low[d] = std::min(box.low[d], x[d]);
    box.high[d] = std::max(box.high[d], x[d]);
  }
}

/// Whether the cell between these nodes, i fastest, holds x: Newton's method for its trilinear map.
bool holds(const std::array<Vec3, 8>& node, const Vec3& x) {
  Vec3 at{0.5, 0.5, 0.5}; // in the unit cube
  constexpr int most_steps = 30;
  for (int step = 0; step < most_steps; ++step) {
    Vec3 here, slope[3];
    for (int n = 0; n < 8; ++n) {
      const double w[3] = {n & 1 ? at.x : 1 - at.x, n & 2 ? at.y : 1 - at.y,
                           n & 4 ? at.z : 1 - at.z};
      const Vec3& corner = node[std::size_t(n)];
      here += w[0] * w[1] * w[2] * corner;
      slope[0] += (n & 1 ? 1 : -1) * w[1] * w[2] * corner;
      slope[1] += (n & 2 ? 1 : -1) * w[0] * w[2] * corner;
      slope[2] += (n & 4 ? 1 : -1) * w[0] * w[1] * corner;
    }
    const Vec3 way = x - here;
    const double volume = dot(slope[0], cross(slope[1], slope[2]));
    const Vec3 change =
        Vec3{dot(way, cross(slope[1], slope[2])), dot(way, cross(slope[2], slope[0])),
             dot(way, cross(slope[0], slope[1]))} /
        volume;
    at += change;
    if (!(norm(at) < 10)) // far outside, or the map is folded there
      return false;
    if (norm(change) < 0.1 * rounding) {
      for (int d = 0; d < 3; ++d)
        if (at[d] < -rounding || at[d] > 1 + rounding)
          return false;
      return true;
    }
  }
  return false;
}

} // namespace

BlockLocator::BlockLocator(const cfd::Mesh& mesh) {
  gather_nodes(mesh);
  find_periods(mesh);
  fill_bins();
}

/// Those of all blocks, from the ranks that own them.
void BlockLocator::gather_nodes(const cfd::Mesh& mesh) {
  const BlockStack stack(mesh.blocks);
  Box around = nothing();
  auto own = mesh.local.begin();
  int rank = 0;
  MPI_Comm_rank(mesh.comm, &rank);
  for (int id = 0; id < int(mesh.blocks.size()); ++id) {
    const cfd::BlockInfo& info = mesh.blocks[std::size_t(id)];
    const auto [ni, nj, nk] = info.cells;
    Nodes& nodes = blocks_.emplace_back(Nodes{info.cells, stack.first(id), {}, 0});
    nodes.at.resize(std::size_t(ni + 1) * std::size_t(nj + 1) * std::size_t(nk + 1));
    if (info.rank == rank) {
      auto to = nodes.at.begin();
      for (int k = 0; k <= nk; ++k)
        for (int j = 0; j <= nj; ++j)
          for (int i = 0; i <= ni; ++i) {
            const std::ptrdiff_t c = own->layout.at(i, j, k);
            *to++ = {own->node[0][c], own->node[1][c], own->node[2][c]};
          }
      ++own;
    }
    static_assert(sizeof(Vec3) == 3 * sizeof(double));
    MPI_Bcast(nodes.at.data(), 3 * int(nodes.at.size()), MPI_DOUBLE, info.rank, mesh.comm);
    for (const Vec3& x : nodes.at)
      include(around, x);
  }
  extent_.low = around.low;
  extent_.high = around.high;
}

void BlockLocator::find_periods(const cfd::Mesh& mesh) {
  for (const cfd::BlockInfo& info : mesh.blocks)
    for (const cfd::Patch& patch : info.patches) {
      if (!patch.link || norm(patch.link->shift) == 0)
        continue;
      const Vec3 shift = patch.link->shift, size = extent_.high - extent_.low;
      int along = 0;
      for (int d = 1; d < 3; ++d)
        if (std::abs(shift[d]) > std::abs(shift[along]))
          along = d;
      // Round-off of grids from files in single precision.
      constexpr double close = 1e-6;
      if (std::abs(norm(shift) - size[along]) > close * size[along] ||
          std::abs(std::abs(shift[along]) - size[along]) > close * size[along])
        throw ConfigError("grid: particles need periodic connections along x, y or z, from end to "
                          "end of the grid; there is one by (" +
                          std::to_string(shift.x) + ", " + std::to_string(shift.y) + ", " +
                          std::to_string(shift.z) + ") m");
      extent_.periodic[std::size_t(along)] = true;
    }
}

std::array<Vec3, 8> BlockLocator::corners(const Cell& c) const {
  const Nodes& nodes = blocks_[std::size_t(c.block)];
  std::array<Vec3, 8> node;
  for (int n = 0; n < 8; ++n)
    node[std::size_t(n)] = nodes(c.at[0] + (n & 1), c.at[1] + (n >> 1 & 1), c.at[2] + (n >> 2));
  return node;
}

void BlockLocator::find_faces(Cell& cell, const std::array<Vec3, 8>& node) {
  for (const Vec3& x : node)
    cell.middle += 0.125 * x;
  auto face = cell.faces.begin();
  for (int direction = 0; direction < 3; ++direction)
    for (const bool high : {false, true}) {
      // The nodes of this side, round it.
      const int step = 1 << direction, a = direction == 0 ? 2 : 1, b = direction == 2 ? 2 : 4;
      const int first = high ? step : 0;
      const std::array side{first, first + a, first + a + b, first + b};
      const Vec3 &p = node[std::size_t(side[0])], &q = node[std::size_t(side[1])],
                 &r = node[std::size_t(side[2])], &s = node[std::size_t(side[3])];
      Vec3 normal = cross(r - p, s - q);
      if (dot(normal, p + q + r + s - 4 * cell.middle) < 0)
        normal = -1 * normal;
      const double length = norm(normal);
      normal = length > 0 ? normal / length : Vec3{};
      const auto height = [&](int n) { return dot(normal, node[std::size_t(n)] - cell.middle); };
      double inner = height(side[0]), outer = inner, size = 0;
      for (const int n : side)
        inner = std::min(inner, height(n));
      for (int n = 0; n < 8; ++n) {
        outer = std::max(outer, height(n));
        size = std::max(size, norm(node[std::size_t(n)] - cell.middle));
      }
      *face++ = {.normal = {float(normal.x), float(normal.y), float(normal.z)},
                 .inner = float(inner - plane_rounding * size),
                 .outer = float(outer + plane_rounding * size)};
    }
  // A cell whose middle is not before all its faces: none of its points is told by planes.
  if (std::ranges::any_of(cell.faces, [](const Face& f) { return !(f.inner > 0); }))
    for (Face& f : cell.faces)
      f.inner = -std::numeric_limits<float>::infinity();
}

/// What lies before the inner planes of all faces is convex, holds the middle and no part of the
/// surface: it is inside.
BlockLocator::Verdict BlockLocator::judge(const Cell& cell, const Vec3& x) {
  const Vec3 away = x - cell.middle;
  const std::array at{float(away.x), float(away.y), float(away.z)};
  bool inside = true;
  for (const Face& f : cell.faces) {
    const float height = f.normal[0] * at[0] + f.normal[1] * at[1] + f.normal[2] * at[2];
    if (height > f.outer)
      return Verdict::outside;
    inside = inside && height < f.inner;
  }
  return inside ? Verdict::inside : Verdict::open;
}

const BlockLocator::Cell& BlockLocator::cell_of(const Index3& in_stack) const {
  const Nodes& block = blocks_[std::size_t(block_of_layer_[std::size_t(in_stack[2])])];
  const auto [ni, nj, nk] = block.cells;
  return cells_[block.first_cell + std::size_t(in_stack[0]) +
                std::size_t(ni) * (std::size_t(in_stack[1]) +
                                   std::size_t(nj) * std::size_t(in_stack[2] - block.first))];
}

std::optional<Index3> BlockLocator::cell(const Vec3& x, const Index3& near) const {
  return judge(cell_of(near), x) == Verdict::inside ? near : cell(x);
}

bool BlockLocator::surely_within(const Index3& cell, const Vec3& centre, double radius) const {
  const Cell& c = cell_of(cell);
  const Vec3 away = centre - c.middle;
  return std::ranges::all_of(c.faces, [&](const Face& f) {
    const Vec3 normal{f.normal[0], f.normal[1], f.normal[2]};
    return dot(normal, away) + radius < double(f.inner);
  });
}

/// The bin of a point, or the one next to it.
Index3 BlockLocator::bin(const Vec3& x) const {
  Index3 b;
  for (int d = 0; d < 3; ++d) {
    const auto n = bins_[std::size_t(d)];
    const double share = (x[d] - extent_.low[d]) / (extent_.high[d] - extent_.low[d]);
    b[std::size_t(d)] = int(std::clamp(share * n, 0.0, n - 1.0));
  }
  return b;
}

/// As many bins as cells, nearly cubes; every cell in those that the box around it touches.
void BlockLocator::fill_bins() {
  for (int b = 0; b < int(blocks_.size()); ++b) {
    blocks_[std::size_t(b)].first_cell = cells_.size();
    block_of_layer_.insert(block_of_layer_.end(), std::size_t(blocks_[std::size_t(b)].cells[2]), b);
    for (int k = 0; k < blocks_[std::size_t(b)].cells[2]; ++k)
      for (int j = 0; j < blocks_[std::size_t(b)].cells[1]; ++j)
        for (int i = 0; i < blocks_[std::size_t(b)].cells[0]; ++i) {
          Cell& c = cells_.emplace_back();
          c.block = b;
          c.at = {i, j, k};
          Box around = nothing();
          for (const Vec3& x : corners(c))
            include(around, x);
          find_faces(c, corners(c));
          const Vec3 margin = rounding * (around.high - around.low);
          c.low = around.low - margin;
          c.high = around.high + margin;
        }
  }
  const Vec3 size = extent_.high - extent_.low;
  const double edge = std::cbrt(size.x * size.y * size.z / double(cells_.size()));
  for (int d = 0; d < 3; ++d)
    bins_[std::size_t(d)] = int(std::clamp(size[d] / edge, 1.0, 1000.0));

  const auto for_bins = [&](const Cell& c, auto&& body) {
    const Index3 low = bin(c.low), high = bin(c.high);
    for (int k = low[2]; k <= high[2]; ++k)
      for (int j = low[1]; j <= high[1]; ++j)
        for (int i = low[0]; i <= high[0]; ++i)
          body(bin_number({i, j, k}));
  };
  bin_start_.assign(bin_number({bins_[0] - 1, bins_[1] - 1, bins_[2] - 1}) + 2, 0);
  for (const Cell& c : cells_)
    for_bins(c, [&](std::size_t b) { ++bin_start_[b + 1]; });
  for (std::size_t b = 1; b < bin_start_.size(); ++b)
    bin_start_[b] += bin_start_[b - 1];
  candidates_.resize(bin_start_.back());
  std::vector<std::uint32_t> next(bin_start_.begin(), bin_start_.end() - 1);
  for (std::size_t n = 0; n < cells_.size(); ++n)
    for_bins(cells_[n], [&](std::size_t b) { candidates_[next[b]++] = std::uint32_t(n); });
}

std::optional<Index3> BlockLocator::cell(const Vec3& x) const {
  for (int d = 0; d < 3; ++d)
    if (!(extent_.low[d] <= x[d] && x[d] <= extent_.high[d]))
      return std::nullopt;
  const std::size_t b = bin_number(bin(x));
  for (std::uint32_t n = bin_start_[b]; n < bin_start_[b + 1]; ++n) {
    const Cell& c = cells_[candidates_[n]];
    const bool near = c.low.x <= x.x && x.x <= c.high.x && c.low.y <= x.y && x.y <= c.high.y &&
                      c.low.z <= x.z && x.z <= c.high.z;
    if (!near)
      continue;
    const Verdict verdict = judge(c, x);
    if (verdict == Verdict::inside || (verdict == Verdict::open && holds(corners(c), x)))
      return Index3{c.at[0], c.at[1], c.at[2] + blocks_[std::size_t(c.block)].first};
  }
  return std::nullopt;
}

Vec3 BlockLocator::fold(const Vec3& x) const {
  Vec3 image = x;
  for (int d = 0; d < 3; ++d) {
    if (!extent_.periodic[std::size_t(d)] || (extent_.low[d] <= x[d] && x[d] <= extent_.high[d]))
      continue;
    const double length = extent_.high[d] - extent_.low[d];
    image[d] = std::clamp(x[d] - std::floor((x[d] - extent_.low[d]) / length) * length,
                          extent_.low[d], extent_.high[d]); // lest it rounds to just outside
  }
  return image;
}

} // namespace granflux::coupling
