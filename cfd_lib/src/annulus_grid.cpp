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

void require(bool holds, const std::string& message) {
  if (!holds)
    throw ConfigError("[grid] " + message);
}

void check(const AnnulusGrid& a) {
  require(a.frame.axis >= 0 && a.frame.axis < 3, "axis: must be x, y or z");
  require(a.length > 0 && std::isfinite(a.length),
          fmt::format("length = {}: must be > 0 (m)", a.length));
  require(a.radial >= 1 && a.tangential >= 1 && a.axial >= 1,
          fmt::format("cells = [{}, {}, {}]: must be at least 1 each", a.radial, a.tangential,
                      a.axial));
}

void check_nodes(const char* key, const std::vector<double>& nodes, int cells) {
  require(nodes.size() == u(cells) + 1,
          fmt::format("{}: {} nodes for {} cells: must be one more than cells", key, nodes.size(),
                      cells));
  for (std::size_t i = 0; i < nodes.size(); ++i)
    require(std::isfinite(nodes[i]) && (i == 0 || nodes[i] > nodes[i - 1]),
            fmt::format("{}: {} after {}: must increase from each to the next", key, nodes[i],
                        i == 0 ? nodes[i] : nodes[i - 1]));
}

/// Radii of the nodes, the first and the last exact.
std::vector<double> radii_of(const AnnulusGrid& a) {
  if (!a.radii.empty()) {
    check_nodes("nodes_radius", a.radii, a.radial);
    require(a.radii.front() > 0, fmt::format("nodes_radius: the first is {}: must be > 0 (m); a "
                                             "full cylinder is kind = \"cylinder\"",
                                             a.radii.front()));
    return a.radii;
  }
  require(a.inner_radius > 0 && a.outer_radius > a.inner_radius && std::isfinite(a.outer_radius),
          fmt::format("inner_radius = {}, outer_radius = {}: must be 0 < inner_radius < "
                      "outer_radius (m); a full cylinder is kind = \"cylinder\"",
                      a.inner_radius, a.outer_radius));
  require(a.growth > 0 && std::isfinite(a.growth),
          fmt::format("growth = {}: must be > 0", a.growth));
  std::vector<double> r{a.inner_radius};
  double sum = 0, width = 1;
  std::vector<double> ends;
  for (int i = 0; i < a.radial; ++i, width *= a.growth)
    ends.push_back(sum += width);
  for (const double end : ends)
    r.push_back(a.inner_radius + (a.outer_radius - a.inner_radius) * (end / sum));
  r.back() = a.outer_radius;
  for (std::size_t i = 1; i < r.size(); ++i)
    require(r[i] > r[i - 1],
            fmt::format("growth = {}: with {} cells the narrowest would have no width", a.growth,
                        a.radial));
  return r;
}

/// Angles of the nodes [degrees].
std::vector<double> angles_of(const AnnulusGrid& a) {
  constexpr double widest = 120; // a cell that spans as much is cut by its own chord
  if (!a.angles.empty()) {
    check_nodes("nodes_angle", a.angles, a.tangential);
    require(a.angles.back() - a.angles.front() <= 360 * (1 + 1e-12),
            fmt::format("nodes_angle: from {} to {}: must span at most 360 (degrees)",
                        a.angles.front(), a.angles.back()));
    for (std::size_t j = 1; j < a.angles.size(); ++j)
      require(a.angles[j] - a.angles[j - 1] < widest,
              fmt::format("nodes_angle: {} after {}: a cell must span less than {} degrees",
                          a.angles[j], a.angles[j - 1], widest));
    return a.angles;
  }
  require(a.sweep > 0 && a.sweep <= 360,
          fmt::format("sweep = {}: must be > 0 and <= 360 (degrees)", a.sweep));
  require(std::isfinite(a.start_angle), "start_angle: must be a number (degrees)");
  require(a.sweep / a.tangential < widest,
          fmt::format("cells = [{}, {}, {}]: too few around for {} degrees: a cell must span less "
                      "than {}",
                      a.radial, a.tangential, a.axial, a.sweep, widest));
  std::vector<double> angles;
  for (int j = 0; j <= a.tangential; ++j)
    angles.push_back(a.start_angle + a.sweep * j / a.tangential);
  return angles;
}

/// The ends of a circle may be rounded.
bool closes(const std::vector<double>& angles) {
  return angles.back() - angles.front() >= 360 * (1 - 1e-12);
}

/// Cosine and sine of the node angles; where the circle closes, the last is the first.
std::vector<std::array<double, 2>> directions(const std::vector<double>& angles) {
  std::vector<std::array<double, 2>> unit;
  for (const double degrees : angles) {
    const double angle = degrees * std::numbers::pi / 180;
    unit.push_back({std::cos(angle), std::sin(angle)});
  }
  if (closes(angles))
    unit.back() = unit.front();
  return unit;
}

/// Arc of each face of the outer circle.
std::vector<int> arc_of_faces(const std::vector<Arc>& arcs, const std::vector<double>& angles) {
  const std::size_t faces_around = angles.size() - 1;
  const auto middle_of = [&](std::size_t j) { return 0.5 * (angles[j] + angles[j + 1]); };
  std::vector<int> arc_of(faces_around, -1);
  for (int n = 0; n < int(arcs.size()); ++n) {
    const Arc& arc = arcs[u(n)];
    if (!(arc.to > arc.from && arc.to - arc.from <= 360))
      throw ConfigError(fmt::format("boundary \"{}\" angles = [{}, {}]: must increase by at most "
                                    "360 (degrees)",
                                    arc.name, arc.from, arc.to));
    int faces = 0;
    for (std::size_t j = 0; j < faces_around; ++j) {
      const double middle = middle_of(j);
      const double past = middle - arc.from - 360 * std::floor((middle - arc.from) / 360);
      if (past >= arc.to - arc.from)
        continue;
      ++faces;
      if (arc_of[j] >= 0)
        throw ConfigError(fmt::format("boundaries \"{}\" and \"{}\" overlap on the outer circle at "
                                      "{:.6g} degrees: each face takes one boundary",
                                      arcs[u(arc_of[j])].name, arc.name, middle));
      arc_of[j] = n;
    }
    if (faces == 0)
      throw ConfigError(fmt::format("boundary \"{}\": no face of the outer circle has its middle "
                                    "between {} and {} degrees",
                                    arc.name, arc.from, arc.to));
  }
  for (std::size_t j = 0; j < faces_around; ++j)
    if (arc_of[j] < 0)
      throw ConfigError(fmt::format("the outer circle has no boundary at {:.6g} degrees: its arcs "
                                    "must cover it",
                                    middle_of(j)));
  return arc_of;
}

void add_outer(const AnnulusGrid& a, const std::vector<double>& angles, Grid& grid) {
  GridBlock& block = grid.blocks.front();
  const Side outer{0, true};
  const int first = int(grid.boundaries.size());
  if (a.arcs.empty()) {
    block.patches.push_back(boundary_side(block.cells, outer, first));
    grid.boundaries.emplace_back("outer");
    return;
  }
  const std::vector<int> arc_of = arc_of_faces(a.arcs, angles);
  const int tangential = block.cells[1];
  for (int j = 0, end = 0; j < tangential; j = end) {
    for (end = j; end < tangential && arc_of[u(end)] == arc_of[u(j)];)
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
  std::vector<double> radii = radii_of(a);
  const std::vector<double> angles = angles_of(a);
  Grid grid;
  GridBlock block;
  block.name = "annulus";
  block.cells = {int(radii.size()) - 1, int(angles.size()) - 1, a.axial};
  block.node = [r = std::move(radii), unit = directions(angles), frame = a.frame, length = a.length,
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
  add_outer(a, angles, grid);
  constexpr Transform straight{1, 2, 3};
  if (closes(angles)) {
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
