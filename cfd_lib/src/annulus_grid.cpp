// SPDX-FileCopyrightText: 2026 The GranFlux developers
// SPDX-License-Identifier: BSD-3-Clause
#include <granflux/cfd/annulus_grid.hpp>

#include <cmath>
#include <numbers>

#include <fmt/format.h>

#include <granflux/cfd/error.hpp>
#include <granflux/cfd/join_blocks.hpp>

namespace granflux::cfd {

namespace {

constexpr std::size_t u(int i) {
  return std::size_t(i);
}

void check(const AnnulusGrid& a) {
  const auto require = [](bool holds, const std::string& message) {
    if (!holds)
      throw ConfigError("[grid] " + message);
  };
  require(a.frame.axis >= 0 && a.frame.axis < 3, "axis: must be x, y or z");
  require(a.inner_radius > 0 && a.outer_radius > a.inner_radius && std::isfinite(a.outer_radius),
          fmt::format("inner_radius = {}, outer_radius = {}: must be 0 < inner_radius < "
                      "outer_radius (m); a full cylinder is kind = \"cylinder\"",
                      a.inner_radius, a.outer_radius));
  require(a.length > 0 && std::isfinite(a.length),
          fmt::format("length = {}: must be > 0 (m)", a.length));
  require(a.sweep > 0 && a.sweep <= 360,
          fmt::format("sweep = {}: must be > 0 and <= 360 (degrees)", a.sweep));
  require(std::isfinite(a.start_angle), "start_angle: must be a number (degrees)");
  require(a.growth > 0 && std::isfinite(a.growth),
          fmt::format("growth = {}: must be > 0", a.growth));
  require(a.radial >= 1 && a.axial >= 1 && a.tangential >= 1,
          fmt::format("cells = [{}, {}, {}]: must be at least 1 each", a.radial, a.tangential,
                      a.axial));
  // A cell that spans 120 degrees or more is cut by its own chord.
  require(a.sweep / a.tangential < 120,
          fmt::format("cells = [{}, {}, {}]: too few around for {} degrees: a cell must span less "
                      "than 120",
                      a.radial, a.tangential, a.axial, a.sweep));
}

/// Radii of the nodes, the first and the last exact.
std::vector<double> radii(const AnnulusGrid& a) {
  std::vector<double> r{a.inner_radius};
  double sum = 0, width = 1;
  std::vector<double> ends;
  for (int i = 0; i < a.radial; ++i, width *= a.growth)
    ends.push_back(sum += width);
  for (const double end : ends)
    r.push_back(a.inner_radius + (a.outer_radius - a.inner_radius) * (end / sum));
  r.back() = a.outer_radius;
  for (std::size_t i = 1; i < r.size(); ++i)
    if (!(r[i] > r[i - 1]))
      throw ConfigError(fmt::format("[grid] growth = {}: with {} cells the narrowest would have no "
                                    "width",
                                    a.growth, a.radial));
  return r;
}

/// Cosine and sine of the node angles; where the circle closes, the last is the first.
std::vector<std::array<double, 2>> directions(const AnnulusGrid& a) {
  std::vector<std::array<double, 2>> unit;
  for (int j = 0; j <= a.tangential; ++j) {
    const int step = a.sweep == 360 && j == a.tangential ? 0 : j;
    const double angle = (a.start_angle + a.sweep * step / a.tangential) * std::numbers::pi / 180;
    unit.push_back({std::cos(angle), std::sin(angle)});
  }
  return unit;
}

/// Arc of each face of the outer circle.
std::vector<int> arc_of_faces(const AnnulusGrid& a) {
  std::vector<int> arc_of(u(a.tangential), -1);
  for (int n = 0; n < int(a.arcs.size()); ++n) {
    const Arc& arc = a.arcs[u(n)];
    if (!(arc.to > arc.from && arc.to - arc.from <= 360))
      throw ConfigError(fmt::format("boundary \"{}\" angles = [{}, {}]: must increase by at most "
                                    "360 (degrees)",
                                    arc.name, arc.from, arc.to));
    int faces = 0;
    for (int j = 0; j < a.tangential; ++j) {
      const double middle = a.start_angle + a.sweep * (j + 0.5) / a.tangential;
      const double past = middle - arc.from - 360 * std::floor((middle - arc.from) / 360);
      if (past >= arc.to - arc.from)
        continue;
      ++faces;
      if (arc_of[u(j)] >= 0)
        throw ConfigError(fmt::format("boundaries \"{}\" and \"{}\" overlap on the outer circle at "
                                      "{:.6g} degrees: each face takes one boundary",
                                      a.arcs[u(arc_of[u(j)])].name, arc.name, middle));
      arc_of[u(j)] = n;
    }
    if (faces == 0)
      throw ConfigError(fmt::format("boundary \"{}\": no face of the outer circle has its middle "
                                    "between {} and {} degrees",
                                    arc.name, arc.from, arc.to));
  }
  for (int j = 0; j < a.tangential; ++j)
    if (arc_of[u(j)] < 0)
      throw ConfigError(fmt::format("the outer circle has no boundary at {:.6g} degrees: its arcs "
                                    "must cover it",
                                    a.start_angle + a.sweep * (j + 0.5) / a.tangential));
  return arc_of;
}

void add_outer(const AnnulusGrid& a, Grid& grid) {
  GridBlock& block = grid.blocks.front();
  const Side outer{0, true};
  const int first = int(grid.boundaries.size());
  if (a.arcs.empty()) {
    block.patches.push_back(boundary_side(block.cells, outer, first));
    grid.boundaries.emplace_back("outer");
    return;
  }
  const std::vector<int> arc_of = arc_of_faces(a);
  for (int j = 0, end = 0; j < a.tangential; j = end) {
    for (end = j; end < a.tangential && arc_of[u(end)] == arc_of[u(j)];)
      ++end;
    Patch patch = boundary_side(block.cells, outer, first + arc_of[u(j)]);
    patch.cells.lo[1] = j, patch.cells.hi[1] = end;
    block.patches.push_back(patch);
  }
  for (const Arc& arc : a.arcs)
    grid.boundaries.push_back(arc.name);
}

} // namespace

Grid make_annulus(const AnnulusGrid& a) {
  check(a);
  Grid grid;
  GridBlock block;
  block.name = "annulus";
  block.cells = {a.radial, a.tangential, a.axial};
  block.node = [r = radii(a), unit = directions(a), frame = a.frame, length = a.length,
                n = a.axial](int i, int j, int k) {
    const auto& [cos, sin] = unit[u(j)];
    return frame.point(r[u(i)] * cos, r[u(i)] * sin, length * (double(k) / n));
  };
  grid.blocks.push_back(std::move(block));

  const auto add_boundary = [&](const Side& side, const char* name) {
    grid.blocks.front().patches.push_back(
        boundary_side(grid.blocks.front().cells, side, int(grid.boundaries.size())));
    grid.boundaries.emplace_back(name);
  };
  add_boundary({0, false}, "inner");
  add_outer(a, grid);
  constexpr Transform straight{1, 2, 3};
  if (a.sweep == 360) {
    join_sides(grid, 0, {1, true}, 0, straight);
  } else {
    add_boundary({1, false}, "start");
    add_boundary({1, true}, "end");
  }
  if (a.periodic_axis) {
    join_sides(grid, 0, {2, true}, 0, straight, a.frame.along(a.length));
  } else {
    add_boundary({2, false}, "low");
    add_boundary({2, true}, "high");
  }
  return grid;
}

} // namespace granflux::cfd
