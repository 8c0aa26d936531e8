// SPDX-FileCopyrightText: 2026 The GranFlux developers
// SPDX-License-Identifier: BSD-3-Clause
#include <granflux/cfd/cylinder_grid.hpp>

#include <cmath>
#include <memory>
#include <numbers>
#include <vector>

#include <fmt/format.h>

#include <granflux/cfd/error.hpp>
#include <granflux/cfd/join_blocks.hpp>

namespace granflux::cfd {

namespace {

using Point = std::array<double, 2>; ///< p and q of the cross-section [m]

constexpr int blocks_across = 5;

constexpr std::size_t u(int i) {
  return std::size_t(i);
}

Point operator+(const Point& a, const Point& b) {
  return {a[0] + b[0], a[1] + b[1]};
}
Point operator*(double s, const Point& a) {
  return {s * a[0], s * a[1]};
}

/// Turned by quarters of a circle, exactly.
Point turned(const Point& a, int quarters) {
  switch (quarters % 4) {
  case 1:
    return {-a[1], a[0]};
  case 2:
    return {-a[0], -a[1]};
  case 3:
    return {a[1], -a[0]};
  default:
    return a;
  }
}

void check(const CylinderGrid& c) {
  const auto require = [](bool holds, const std::string& message) {
    if (!holds)
      throw ConfigError("[grid] " + message);
  };
  require(c.frame.axis >= 0 && c.frame.axis < 3, "axis: must be x, y or z");
  require(c.radius > 0 && std::isfinite(c.radius),
          fmt::format("radius = {}: must be > 0 (m)", c.radius));
  require(c.length > 0 && std::isfinite(c.length),
          fmt::format("length = {}: must be > 0 (m)", c.length));
  require(c.core >= 2, fmt::format("core = {}: must be at least 2 cells", c.core));
  require(c.radial >= 1, fmt::format("radial = {}: must be at least 1 cell", c.radial));
  require(c.axial >= 1, fmt::format("axial = {}: must be at least 1 cell", c.axial));
  require(
      c.axial_blocks >= 1 && (c.axial_blocks == 1 || c.axial >= 2 * c.axial_blocks),
      fmt::format("axial_blocks = {} with axial = {}: at least 1 block, and at least 2 cells in "
                  "each",
                  c.axial_blocks, c.axial));
  require(
      c.core_radius > 0 && c.core_radius < 1,
      fmt::format("core_radius = {}: must be > 0 and < 1 (share of the radius)", c.core_radius));
  require(c.bulge >= 0 && c.bulge < 1,
          fmt::format("bulge = {}: must be >= 0 and < 1 (1 would flatten the corners of the core)",
                      c.bulge));
  require(c.growth > 0 && std::isfinite(c.growth),
          fmt::format("growth = {}: must be > 0", c.growth));
}

/// The nodes of one cross-section. What two blocks share is the same number in both.
struct CrossSection {
  int core, radial;
  std::vector<Point> side, wall;  ///< the block at 0 degrees: along the core, along the wall
  std::vector<double> share;      ///< of the way from core to wall, for each of its nodes
  std::vector<Point> core_points; ///< i fastest

  explicit CrossSection(const CylinderGrid& c) : core(c.core), radial(c.radial) {
    constexpr double quarter = std::numbers::pi / 4;
    const double corner = c.core_radius * c.radius;
    for (int j = 0; j <= core; ++j) {
      // From the middle outwards, so that the halves mirror each other exactly.
      const int from_middle = 2 * j - core;
      const double s = double(from_middle) / core;
      const Point direction{std::cos(quarter * s), std::sin(quarter * s)};
      const Point straight{std::numbers::sqrt2 / 2, std::numbers::sqrt2 / 2 * s};
      side.push_back(corner * ((1 - c.bulge) * straight + c.bulge * direction));
      wall.push_back(c.radius * direction);
    }
    // Corners at exactly 45 degrees: two sides must meet in one point.
    side.front() = {side.back()[0], -side.back()[0]}, side.back()[1] = side.back()[0];
    wall.front() = {wall.back()[0], -wall.back()[0]}, wall.back()[1] = wall.back()[0];

    double sum = 0, width = 1;
    share.push_back(0);
    for (int i = 0; i < radial; ++i, width *= c.growth)
      share.push_back(sum += width);
    for (double& s : share)
      s /= sum;
    share.back() = 1;
    for (std::size_t i = 1; i < share.size(); ++i)
      if (!(share[i] > share[i - 1]))
        throw ConfigError(fmt::format("[grid] growth = {}: with {} cells the narrowest would have "
                                      "no width",
                                      c.growth, radial));
    for (int j = 0; j <= core; ++j)
      for (int i = 0; i <= core; ++i)
        core_points.push_back(core_point(i, j));
  }

  /// Node j of the core's side that faces the block at 90 degrees times `quarter`.
  [[nodiscard]] Point side_point(int quarter, int j) const { return turned(side[u(j)], quarter); }

  [[nodiscard]] Point outer_point(int quarter, int i, int j) const {
    if (i == 0)
      return side_point(quarter, j);
    return turned((1 - share[u(i)]) * side[u(j)] + share[u(i)] * wall[u(j)], quarter);
  }

private:
  /// Between the four sides: transfinite interpolation after Coons.
  [[nodiscard]] Point core_point(int i, int j) const {
    const int n = core;
    if (i == n)
      return side_point(0, j);
    if (j == n)
      return side_point(1, n - i);
    if (i == 0)
      return side_point(2, n - j);
    if (j == 0)
      return side_point(3, i);
    const double x = double(i) / n, y = double(j) / n;
    const Point between_sides = x * side_point(0, j) + (1 - x) * side_point(2, n - j) +
                                y * side_point(1, n - i) + (1 - y) * side_point(3, i);
    const Point of_corners = x * y * side_point(0, n) + (1 - x) * y * side_point(1, n) +
                             (1 - x) * (1 - y) * side_point(2, n) + x * (1 - y) * side_point(3, n);
    return between_sides + -1. * of_corners;
  }
};

} // namespace

Grid make_cylinder(const CylinderGrid& c) {
  check(c);
  const auto section = std::make_shared<const CrossSection>(c);
  Grid grid;
  const auto add_boundary = [&](const char* name) {
    grid.boundaries.emplace_back(name);
    return int(grid.boundaries.size()) - 1;
  };
  const int wall = add_boundary("wall");
  const int low = c.periodic_axis ? -1 : add_boundary("low");
  const int high = c.periodic_axis ? -1 : add_boundary("high");

  for (int layer = 0; layer < c.axial_blocks; ++layer) {
    const int first = int(std::int64_t(c.axial) * layer / c.axial_blocks);
    const int end = int(std::int64_t(c.axial) * (layer + 1) / c.axial_blocks);
    const auto height = [first, length = c.length, n = c.axial](int k) {
      return length * (double(first + k) / n);
    };
    const std::string suffix = c.axial_blocks > 1 ? fmt::format(" {}", layer) : "";
    const auto core_node = [=, frame = c.frame](int i, int j, int k) {
      const Point& x = section->core_points[u(i + (section->core + 1) * j)];
      return frame.point(x[0], x[1], height(k));
    };
    grid.blocks.push_back({"core" + suffix, {c.core, c.core, end - first}, core_node, {}});
    for (int quarter = 0; quarter < 4; ++quarter) {
      const auto node = [=, frame = c.frame](int i, int j, int k) {
        const Point x = section->outer_point(quarter, i, j);
        return frame.point(x[0], x[1], height(k));
      };
      grid.blocks.push_back({fmt::format("{} degrees{}", 90 * quarter, suffix),
                             {c.radial, c.core, end - first},
                             node,
                             {}});
    }
  }

  // Outwards and around, as the core's directions see it.
  constexpr std::array<Transform, 4> into_core{{{1, 2, 3}, {2, -1, 3}, {-1, -2, 3}, {-2, 1, 3}}};
  constexpr Transform straight{1, 2, 3};
  for (int core = 0; core < int(grid.blocks.size()); core += blocks_across) {
    for (int quarter = 0; quarter < 4; ++quarter) {
      const int id = core + 1 + quarter;
      join_sides(grid, id, {0, false}, core, into_core[u(quarter)]);
      join_sides(grid, id, {1, true}, core + 1 + (quarter + 1) % 4, straight);
      GridBlock& block = grid.blocks[u(id)];
      block.patches.push_back(boundary_side(block.cells, {0, true}, wall));
    }
    const bool top = core + blocks_across == int(grid.blocks.size());
    for (int id = core; id < core + blocks_across; ++id) {
      GridBlock& block = grid.blocks[u(id)];
      if (!top)
        join_sides(grid, id, {2, true}, id + blocks_across, straight);
      else if (c.periodic_axis)
        join_sides(grid, id, {2, true}, id - core, straight, c.frame.along(c.length));
      else
        block.patches.push_back(boundary_side(block.cells, {2, true}, high));
      if (core == 0 && !c.periodic_axis)
        block.patches.push_back(boundary_side(block.cells, {2, false}, low));
    }
  }
  return grid;
}

} // namespace granflux::cfd
