// SPDX-FileCopyrightText: 2026 The GranFlux developers
// SPDX-License-Identifier: BSD-3-Clause
#include "read_grid.hpp"

#include <algorithm>
#include <cstdint>
#include <filesystem>
#include <limits>

#include <fmt/format.h>

#include <granflux/cfd/deal_blocks.hpp>

namespace granflux::cfd {

namespace {

constexpr std::array<const char*, 3> axis_names{"x", "y", "z"};
constexpr int most_cells = 1'000'000; ///< along one direction
constexpr std::int64_t most_cells_in_all = std::numeric_limits<std::int32_t>::max();
constexpr const char* too_many = "at most 2147483647 cells in all";

void read_uniform_box(const CaseTable& table, BoxGrid& grid) {
  const Vec3 origin = table.vector("origin", Vec3{}, any_number, "m");
  const Vec3 size = table.vector("size", positive, "m");
  const Index3 cells = table.integers("cells", 1, most_cells);
  for (int d = 0; d < 3; ++d)
    grid.nodes[std::size_t(d)] = uniform_nodes(origin[d], size[d], cells[std::size_t(d)]);
}

std::vector<double> read_nodes(const CaseTable& table, const std::string& key, NumberRange range,
                               std::string_view unit) {
  std::vector<double> nodes = table.numbers(key, 2, range, unit);
  if (!std::is_sorted(nodes.begin(), nodes.end(), std::less_equal<>()))
    table.fail(key, fmt::format("node coordinates that increase from each to the next ({})", unit));
  return nodes;
}

/// As many nodes as a number of cells has.
std::vector<double> read_nodes(const CaseTable& table, const std::string& key, int cells,
                               NumberRange range, std::string_view unit) {
  std::vector<double> nodes = read_nodes(table, key, range, unit);
  if (nodes.size() != std::size_t(cells) + 1)
    table.fail(key, fmt::format("{} numbers, one more than cells", cells + 1));
  return nodes;
}

void read_stretched_box(const CaseTable& table, BoxGrid& grid) {
  for (const char* key : {"origin", "size", "cells"})
    table.refuse(key, "nodes_x, nodes_y and nodes_z take its place");
  for (std::size_t d = 0; d < 3; ++d)
    grid.nodes[d] = read_nodes(table, std::string("nodes_") + axis_names[d], any_number, "m");
}

BoxGrid read_box(const CaseTable& table) {
  BoxGrid grid;
  const auto stretched = std::ranges::count_if( // asks for all three, so that all are known
      axis_names, [&](const char* axis) { return table.has(std::string("nodes_") + axis); });
  if (stretched)
    read_stretched_box(table, grid);
  else
    read_uniform_box(table, grid);

  std::int64_t cells = 1;
  for (const auto& nodes : grid.nodes)
    cells *= std::int64_t(nodes.size()) - 1;
  if (cells > most_cells_in_all)
    table.fail(stretched ? "nodes_x" : "cells", too_many);

  grid.periodic = table.flags("periodic", {false, false, false});
  if (table.has("blocks"))
    grid.blocks = table.integers("blocks", 1, most_cells);
  return grid;
}

AxialFrame read_frame(const CaseTable& table) {
  return {table.choice<int>("axis", 2, {{"x", 0}, {"y", 1}, {"z", 2}}),
          table.vector("origin", Vec3{}, any_number, "m")};
}

AnnulusGrid read_annulus(const CaseTable& table) {
  AnnulusGrid grid;
  grid.frame = read_frame(table);
  grid.length = table.number("length", positive, "m");
  grid.periodic_axis = table.flag("periodic_axis", false);
  const Index3 cells = table.integers("cells", 1, most_cells);
  if (cell_count(cells) > most_cells_in_all)
    table.fail("cells", too_many);
  grid.radial = cells[0], grid.tangential = cells[1], grid.axial = cells[2];
  if (table.has("nodes_radius")) {
    for (const char* key : {"inner_radius", "outer_radius", "growth"})
      table.refuse(key, "nodes_radius takes its place");
    grid.radii = read_nodes(table, "nodes_radius", cells[0], positive, "m");
  } else {
    grid.inner_radius = table.number("inner_radius", positive, "m");
    grid.outer_radius = table.number("outer_radius", positive, "m");
    if (grid.outer_radius <= grid.inner_radius)
      table.fail("outer_radius", "larger than inner_radius (m)");
    grid.growth = table.number("growth", grid.growth, positive, "");
  }
  if (table.has("nodes_angle")) {
    for (const char* key : {"start_angle", "sweep"})
      table.refuse(key, "nodes_angle takes its place");
    grid.angles = read_nodes(table, "nodes_angle", cells[1], any_number, "degrees");
  } else {
    grid.start_angle = table.number("start_angle", grid.start_angle, any_number, "degrees");
    grid.sweep = table.number("sweep", grid.sweep, {.low = 0, .high = 360, .low_included = false},
                              "degrees");
    if (grid.sweep >= 120. * grid.tangential)
      table.fail("cells", "more around: a cell must span less than 120 degrees");
  }
  return grid;
}

CylinderGrid read_cylinder(const CaseTable& table) {
  CylinderGrid grid;
  grid.frame = read_frame(table);
  grid.radius = table.number("radius", positive, "m");
  grid.length = table.number("length", positive, "m");
  const Index3 cells = table.integers("cells", 1, most_cells);
  if (cell_count({4 * cells[0] + cells[1], cells[1], cells[2]}) > most_cells_in_all)
    table.fail("cells", too_many);
  if (cells[1] < 2)
    table.fail("cells", "at least 2 across the core");
  grid.radial = cells[0], grid.core = cells[1], grid.axial = cells[2];
  grid.axial_blocks = table.integer("axial_blocks", 1, 1, std::max(1, grid.axial / 2));
  constexpr NumberRange inside{.low = 0, .high = 1, .low_included = false, .high_included = false};
  grid.core_radius = table.number("core_radius", grid.core_radius, inside, "share of the radius");
  grid.bulge = table.number("bulge", grid.bulge, {.low = 0, .high = 1, .high_included = false}, "");
  grid.growth = table.number("growth", grid.growth, positive, "");
  grid.periodic_axis = table.flag("periodic_axis", false);
  return grid;
}

/// A path of the case file is meant from where the case file is.
CgnsGrid read_cgns(const CaseTable& table, const std::string& case_file) {
  CgnsGrid grid;
  const std::filesystem::path path = table.text("file");
  grid.file = (std::filesystem::path(case_file).parent_path() / path).string();
  grid.base = table.text("base", "");
  if (table.has("scale"))
    grid.scale = table.number("scale", positive, "m per unit of the file");
  return grid;
}

BoxPatch read_box_patch(const CaseTable& table, const std::string& name, const BoxGrid& grid) {
  BoxPatch patch;
  patch.name = name;
  patch.side = table.choice<Side>("side", {{"x_low", {0, false}},
                                           {"x_high", {0, true}},
                                           {"y_low", {1, false}},
                                           {"y_high", {1, true}},
                                           {"z_low", {2, false}},
                                           {"z_high", {2, true}}});
  patch.from = table.vector("from", patch.from, any_number, "m");
  patch.to = table.vector("to", patch.to, any_number, "m");
  for (int d = 0; d < 3; ++d)
    if (d != patch.side.direction && patch.to[d] < patch.from[d])
      table.fail("to", "not below `from` along " + std::string(axis_names[std::size_t(d)]));
  if (grid.periodic[std::size_t(patch.side.direction)])
    table.fail("side", "a side that [grid] periodic does not connect to the opposite one");
  return patch;
}

Arc read_arc(const CaseTable& table, const std::string& name) {
  const std::vector<double> angles = table.numbers("angles", 2, any_number, "degrees");
  if (angles.size() != 2 || !(angles[1] > angles[0]) || angles[1] - angles[0] > 360)
    table.fail("angles", "two numbers, the second larger by at most 360 (degrees)");
  return {name, angles[0], angles[1]};
}

} // namespace

GridDescription read_grid(CaseFile& file) {
  const CaseTable table = file.table("grid");
  const std::string kind = table.word("kind", "box", {"box", "annulus", "cylinder", "cgns"});
  if (kind == "annulus")
    return read_annulus(table);
  if (kind == "cylinder")
    return read_cylinder(table);
  if (kind == "cgns")
    return read_cgns(table, file.name());
  return read_box(table);
}

BoundaryPlace read_boundary_place(const CaseTable& table, GridDescription& grid) {
  BoundaryPlace place{table.text("name"), std::nullopt};
  if (auto* box = std::get_if<BoxGrid>(&grid)) {
    table.refuse("angles", "only an annulus has arcs");
    box->patches.push_back(read_box_patch(table, place.name, *box));
    place.side = box->patches.back().side;
    return place;
  }
  for (const char* key : {"side", "from", "to"})
    table.refuse(key, "only a box has sides; the name is that of a boundary of the grid");
  auto* annulus = std::get_if<AnnulusGrid>(&grid);
  if (!annulus)
    table.refuse("angles", "only an annulus has arcs");
  else if (table.has("angles"))
    annulus->arcs.push_back(read_arc(table, place.name));
  return place;
}

} // namespace granflux::cfd
