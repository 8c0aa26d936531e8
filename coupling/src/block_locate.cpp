// SPDX-FileCopyrightText: 2026 The GranFlux developers
// SPDX-License-Identifier: BSD-3-Clause
#include <granflux/coupling/block_locate.hpp>

#include <algorithm>
#include <atomic>
#include <bit>
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
  static std::atomic<long> editions = 0;
  edition_ = ++editions;
  gather_nodes(mesh);
  find_periods(mesh);
  fill_bins();
  find_neighbours();
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
      extent_.periodic[std::size_t(along)] = any_period_ = true;
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
                 .outer = float(outer + plane_rounding * size),
                 .across = none};
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

int BlockLocator::number(const Index3& in_stack) const {
  const Nodes& block = blocks_[std::size_t(block_of_layer_[std::size_t(in_stack[2])])];
  const auto [ni, nj, nk] = block.cells;
  return int(block.first_cell) + in_stack[0] +
         ni * (in_stack[1] + nj * (in_stack[2] - block.first));
}

Index3 BlockLocator::in_stack(int cell) const {
  const Cell& c = cells_[std::size_t(cell)];
  return {c.at[0], c.at[1], c.at[2] + blocks_[std::size_t(c.block)].first};
}

/// The face whose inner plane x is farthest beyond, or least far behind.
BlockLocator::Outermost BlockLocator::outermost(const Cell& cell, const Vec3& x) {
  const Vec3 away = x - cell.middle;
  const std::array at{float(away.x), float(away.y), float(away.z)};
  const auto of_face = [&](const Face& f) {
    const float height = f.normal[0] * at[0] + f.normal[1] * at[1] + f.normal[2] * at[2];
    return Outermost{height - f.inner, f.across};
  };
  Outermost found = of_face(cell.faces[0]); // not a number if x is not
  for (std::size_t f = 1; f < cell.faces.size(); ++f)
    if (const Outermost other = of_face(cell.faces[f]); other.beyond > found.beyond)
      found = other;
  return found;
}

std::optional<Index3> BlockLocator::cell(const Vec3& x, const Index3& near) const {
  constexpr int most_steps = 4;
  int at = number(near);
  for (int step = 0; step < most_steps && at != none; ++step) {
    const Outermost face = outermost(cells_[std::size_t(at)], x);
    if (face.beyond < 0)
      return in_stack(at);
    at = face.across;
  }
  return cell(x);
}

double BlockLocator::room(const Index3& cell, const Vec3& x) const {
  return -double(outermost(cells_[std::size_t(number(cell))], x).beyond);
}

/// Finds the cells of the points of one set: of all points at once whether they lie in a cell, then
/// of the cell that the first of those left leads to. A set of points is one bit for each.
class BlockLocator::PointSearch {
public:
  PointSearch(const BlockLocator& blocks, const PointSet& points, const Vec3& centre, double radius)
      : blocks_(blocks), points_(points), centre_(centre), radius_(float(radius)) {}

  PointsInCells from(int near) {
    left_ = points_.count == most ? ~0u : (1u << points_.count) - 1;
    take(near);
    while (left_ != 0) {
      const int k = std::countr_zero(left_);
      if (const int next = cells_ < most ? leads_to(k, near) : none; next != none)
        take(next);
      else
        search(k);
    }
    return in_order();
  }

private:
  static constexpr int most = PointSet::most;
  struct Taken {
    int cell; ///< number
    std::uint32_t points;
  };
  /// A face that points of its cell may move to.
  struct Ahead {
    std::array<float, 3> normal;
    float room; ///< of the point nearest to it
  };

  [[nodiscard]] Vec3 place(int k) const {
    const auto n = std::size_t(k);
    return centre_ + double(radius_) * Vec3{points_.x[n], points_.y[n], points_.z[n]};
  }
  [[nodiscard]] int slot(int cell) const {
    int s = 0;
    while (s < cells_ && taken_[std::size_t(s)].cell != cell)
      ++s;
    return s;
  }

  /// The first cell on the way to a point that has not been looked at, or none.
  [[nodiscard]] int leads_to(int k, int near) const {
    constexpr int most_steps = 4;
    int at = near;
    for (int step = 0; step < most_steps && at != none; ++step) {
      at = outermost(blocks_.cells_[std::size_t(at)], place(k)).across;
      if (slot(at) == cells_)
        return at;
    }
    return none;
  }

  /// The points that surely lie in a cell.
  void take(int number) {
    constexpr std::size_t sides = 6;
    const Cell& cell = blocks_.cells_[std::size_t(number)];
    const Vec3 away = centre_ - cell.middle;
    const std::array at{float(away.x), float(away.y), float(away.z)};
    std::array<float, sides> height, nx, ny, nz;
    for (std::size_t s = 0; s < sides; ++s) {
      const Face& f = cell.faces[s];
      height[s] = f.normal[0] * at[0] + f.normal[1] * at[1] + f.normal[2] * at[2] - f.inner;
      nx[s] = radius_ * f.normal[0];
      ny[s] = radius_ * f.normal[1];
      nz[s] = radius_ * f.normal[2];
    }
    alignas(64) std::array<std::array<float, most>, sides> h;
    std::uint32_t inside = 0;
#pragma omp simd reduction(| : inside)
    for (std::size_t k = 0; k < most; ++k) {
      float beyond = -Room::unbounded;
#pragma GCC unroll 8
      for (std::size_t s = 0; s < sides; ++s) {
        h[s][k] = height[s] + nx[s] * points_.x[k] + ny[s] * points_.y[k] + nz[s] * points_.z[k];
        beyond = h[s][k] > beyond ? h[s][k] : beyond;
      }
      const std::uint32_t bit = left_ & (1u << k);
      inside |= beyond < 0 ? bit : 0u;
    }
    left_ &= ~inside;
    taken_[std::size_t(cells_++)] = {number, inside};
    if (inside == 0)
      return;
    for (std::size_t s = 0; s < sides; ++s) {
      float room = Room::unbounded;
#pragma omp simd reduction(min : room)
      for (std::size_t k = 0; k < most; ++k) {
        const float own = (inside & (1u << k)) != 0 ? -h[s][k] : Room::unbounded;
        room = own < room ? own : room;
      }
      faces_[std::size_t(face_count_++)] = {cell.faces[s].normal, room};
    }
  }

  /// A point that planes do not tell. Outside all cells it counts with the centre.
  void search(int k) {
    const std::uint32_t bit = 1u << k;
    const int found = blocks_.find(place(k));
    if (found == none) {
      taken_[0].points |= bit;
      ball_ = std::min(ball_, float(blocks_.away_from_all(place(k))));
    } else {
      const int s = slot(found);
      if (s == cells_)
        take(found);
      if ((left_ & bit) == 0)
        return;
      taken_[std::size_t(s)].points |= bit; // next to a face
      ball_ = 0;
    }
    left_ &= ~bit;
  }

  /// Before the nearest face and those that face it; before all others a ball.
  [[nodiscard]] Room room() const {
    constexpr float parallel = 1e-5F; // least difference of normals that counts
    const auto end = faces_.begin() + face_count_;
    const auto nearest = std::min_element(
        faces_.begin(), end, [](const Ahead& a, const Ahead& b) { return a.room < b.room; });
    if (nearest == end)
      return {};
    Room found{.ball = ball_, .normal = nearest->normal};
    const auto is_normal = [&](const Ahead& face, float sign) {
      float squared = 0;
      for (std::size_t d = 0; d < 3; ++d) {
        const float difference = face.normal[d] - sign * found.normal[d];
        squared += difference * difference;
      }
      return squared < parallel * parallel;
    };
    for (auto face = faces_.begin(); face != end; ++face) {
      if (face->room >= found.ball)
        continue;
      if (is_normal(*face, 1))
        found.high = std::min(found.high, face->room);
      else if (is_normal(*face, -1))
        found.low = std::max(found.low, -face->room);
      else
        found.ball = face->room;
    }
    const float unlike = parallel * found.ball;
    found.high -= unlike;
    found.low += unlike;
    return found;
  }

  [[nodiscard]] PointsInCells in_order() {
    const auto end = std::remove_if(taken_.begin(), taken_.begin() + cells_,
                                    [](const Taken& t) { return t.points == 0; });
    std::sort(taken_.begin(), end, [](const Taken& a, const Taken& b) {
      return std::countr_zero(a.points) < std::countr_zero(b.points);
    });
    PointsInCells found;
    found.room = room();
    for (auto t = taken_.begin(); t != end; ++t)
      found.parts[std::size_t(found.count++)] = {blocks_.in_stack(t->cell),
                                                 std::popcount(t->points)};
    return found;
  }

  const BlockLocator& blocks_;
  const PointSet& points_;
  const Vec3 centre_;
  const float radius_;
  std::uint32_t left_ = 0;            ///< points whose cell is not known yet
  std::array<Taken, 2 * most> taken_; ///< cells looked at, that of the centre first
  int cells_ = 0;
  std::array<Ahead, 6 * 2 * most> faces_;
  int face_count_ = 0;
  float ball_ = std::numeric_limits<float>::max();
};

BlockLocator::PointsInCells BlockLocator::cells(const PointSet& points, const Vec3& centre,
                                                double radius, const Index3& near) const {
  return PointSearch(*this, points, centre, radius).from(number(near));
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

/// Within a block by number, from block to block by a point just outside.
void BlockLocator::find_neighbours() {
  for (Cell& c : cells_) {
    const Index3& cells = blocks_[std::size_t(c.block)].cells;
    const int here = int(&c - cells_.data());
    const std::array step{1, cells[0], cells[0] * cells[1]};
    const std::array<Vec3, 8> node = corners(c);
    for (std::size_t d = 0; d < 3; ++d)
      for (const int high : {0, 1}) {
        int& across = c.faces[2 * d + std::size_t(high)].across;
        const int beside = c.at[d] + (high ? 1 : -1);
        if (beside >= 0 && beside < cells[d]) {
          across = here + (high ? step[d] : -step[d]);
          continue;
        }
        Vec3 middle; // of the face
        for (int n = 0; n < 8; ++n)
          if ((n >> d & 1) == high)
            middle += 0.25 * node[std::size_t(n)];
        constexpr double just_outside = 0.01;
        across = find(middle + just_outside * (middle - c.middle));
      }
  }
}

int BlockLocator::find(const Vec3& x) const {
  for (int d = 0; d < 3; ++d)
    if (!(extent_.low[d] <= x[d] && x[d] <= extent_.high[d]))
      return none;
  const std::size_t b = bin_number(bin(x));
  for (std::uint32_t n = bin_start_[b]; n < bin_start_[b + 1]; ++n) {
    const Cell& c = cells_[candidates_[n]];
    const bool near = c.low.x <= x.x && x.x <= c.high.x && c.low.y <= x.y && x.y <= c.high.y &&
                      c.low.z <= x.z && x.z <= c.high.z;
    if (!near)
      continue;
    const Verdict verdict = judge(c, x);
    if (verdict == Verdict::inside || (verdict == Verdict::open && holds(corners(c), x)))
      return int(candidates_[n]);
  }
  return none;
}

double BlockLocator::away_from_all(const Vec3& x) const {
  double away = std::numeric_limits<double>::max();
  // As far as the bin goes, whose cells are looked at.
  const Index3 own = bin(x);
  for (int d = 0; d < 3; ++d) {
    const double size = extent_.high[d] - extent_.low[d], width = size / bins_[std::size_t(d)];
    const double low = extent_.low[d] + own[std::size_t(d)] * width;
    const bool first = own[std::size_t(d)] == 0,
               last = own[std::size_t(d)] + 1 == bins_[std::size_t(d)];
    if (!first)
      away = std::min(away, x[d] - low - rounding * size);
    if (!last)
      away = std::min(away, low + width - x[d] - rounding * size);
  }
  const std::size_t b = bin_number(own);
  for (std::uint32_t n = bin_start_[b]; n < bin_start_[b + 1]; ++n) {
    const Cell& c = cells_[candidates_[n]];
    const Vec3 from_middle = x - c.middle;
    double beyond = 0; // a plane with the whole cell behind it
    for (const Face& f : c.faces)
      beyond = std::max(beyond, dot(Vec3{f.normal[0], f.normal[1], f.normal[2]}, from_middle) -
                                    double(f.outer));
    away = std::min(away, beyond);
  }
  return away;
}

std::optional<Index3> BlockLocator::cell(const Vec3& x) const {
  const int found = find(x);
  return found == none ? std::nullopt : std::optional(in_stack(found));
}

Vec3 BlockLocator::image(const Vec3& x) const {
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
