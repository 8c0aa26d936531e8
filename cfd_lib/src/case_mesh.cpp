// SPDX-FileCopyrightText: 2026 The GranFlux developers
// SPDX-License-Identifier: BSD-3-Clause
#include <granflux/cfd/case_mesh.hpp>

#include <algorithm>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <granflux/cfd/error.hpp>
#include <granflux/cfd/split_blocks.hpp>

namespace granflux::cfd {

namespace {

/// Every boundary of the grid has a condition, and every condition its boundary.
void check_names(const std::vector<std::string>& boundaries,
                 const std::vector<BoundaryCondition>& conditions) {
  const auto existing = fmt::format("the grid's boundaries are: {}", fmt::join(boundaries, ", "));
  for (const BoundaryCondition& condition : conditions)
    if (std::find(boundaries.begin(), boundaries.end(), condition.name) == boundaries.end())
      throw ConfigError(
          fmt::format("[[boundary]] \"{}\": the grid has no boundary of that name; {}",
                      condition.name, boundaries.empty() ? "it has none at all" : existing));
  for (const std::string& name : boundaries)
    if (std::none_of(conditions.begin(), conditions.end(),
                     [&](const BoundaryCondition& c) { return c.name == name; }))
      throw ConfigError(
          fmt::format("boundary \"{}\" of the grid has no [[boundary]]; {}", name, existing));
}

/// A mean pressure gradient drives gas only where it can flow in a circle.
void check_driving(const Grid& grid, const Vec3& gradient) {
  std::array<bool, 3> periodic{};
  for (const GridBlock& block : grid.blocks)
    for (const Patch& patch : block.patches)
      for (int d = 0; d < 3; ++d)
        if (patch.link && patch.link->shift[d] != 0)
          periodic[std::size_t(d)] = true;
  for (int d = 0; d < 3; ++d)
    if (gradient[d] != 0 && !periodic[std::size_t(d)])
      throw ConfigError(
          fmt::format("[fluid] driving_pressure_gradient: must be 0 along {}, which is "
                      "not periodic: there, boundaries drive the flow (Pa/m)",
                      "xyz"[d]));
}

struct MakeMesh {
  const GasCase& gas_case;
  MPI_Comm comm;

  Mesh operator()(const BoxGrid& box) const { return make_box_mesh(box, comm); }
  Mesh operator()(const AnnulusGrid& annulus) const { return from_blocks(make_annulus(annulus)); }
  Mesh operator()(const CylinderGrid& cylinder) const {
    return from_blocks(make_cylinder(cylinder));
  }
  Mesh operator()(const CgnsGrid& file) const { return from_blocks(read_cgns_grid(file, comm)); }

private:
  [[nodiscard]] Mesh from_blocks(const Grid& grid) const {
    check_names(grid.boundaries, gas_case.boundaries);
    check_driving(grid, gas_case.fluid.driving_pressure_gradient);
    int ranks = 1;
    MPI_Comm_size(comm, &ranks);
    return make_mesh(split_for_ranks(grid, ranks), comm);
  }
};

} // namespace

Mesh make_mesh(const GasCase& gas_case, MPI_Comm comm) {
  return std::visit(MakeMesh{gas_case, comm}, gas_case.grid);
}

} // namespace granflux::cfd
