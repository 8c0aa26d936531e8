// SPDX-FileCopyrightText: 2026 The GranFlux developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>
#include <gtest/gtest.h>
#include <mpi.h>
#include <string>
#include <vector>

#include <cgnslib.h>

#include <granflux/cfd/mesh.hpp>

#include "rank_folder.hpp"

namespace granflux::cfd::testing {

using granflux::test::rank_here;
using granflux::test::RankFolder;

/// How another program might write a grid.
struct RawCgns {
  bool single_precision = false, families = true, faces = false, units = true;
  LengthUnits_t unit = CGNS_ENUMV(Meter);
  float translation_sign = -1; ///< -1 as the standard has it
  float rotation = 0;          ///< of periodic connections, degrees
  int skipped_link = -1;       ///< block whose first link is left out
  int general_link = -1;       ///< block whose first link is written as a general connection
  int wrong_transform = -1;    ///< block whose first link has a wrong transform
  int skipped_boundary = -1;   ///< block whose first boundary condition is left out
  /// Called with file and base before the file is closed.
  std::function<void(int, int)> more;
};

namespace raw {

inline void ok(int status) {
  ASSERT_EQ(status, CG_OK) << cg_get_error();
}

inline std::array<cgsize_t, 6> nodes(const Patch& p) {
  std::array<cgsize_t, 6> range{};
  for (std::size_t d = 0; d < 3; ++d) {
    range[d] = p.cells.lo[d] + 1, range[d + 3] = p.cells.hi[d] + 1;
    if (p.side.direction == int(d))
      range[d] = range[d + 3] = p.side.high ? p.cells.hi[d] + 1 : p.cells.lo[d] + 1;
  }
  return range;
}

inline void boundary(int file, int zone, const Grid& grid, const Patch& p, int number,
                     const RawCgns& way) {
  std::array<cgsize_t, 6> range = nodes(p);
  if (way.faces)
    for (std::size_t d = 0; d < 3; ++d)
      if (int(d) != p.side.direction)
        --range[d + 3];
  const std::string& name = grid.boundaries[std::size_t(p.boundary)];
  int bc = 0;
  ok(cg_boco_write(file, 1, zone, (way.families ? "bc" + std::to_string(number) : name).c_str(),
                   CGNS_ENUMV(BCWall), CGNS_ENUMV(PointRange), 2, range.data(), &bc));
  constexpr std::array<GridLocation_t, 3> face{CGNS_ENUMV(IFaceCenter), CGNS_ENUMV(JFaceCenter),
                                               CGNS_ENUMV(KFaceCenter)};
  if (way.faces)
    ok(cg_boco_gridlocation_write(file, 1, zone, bc, face[std::size_t(p.side.direction)]));
  if (way.families) {
    ok(cg_goto(file, 1, "Zone_t", zone, "ZoneBC_t", 1, "BC_t", bc, "end"));
    ok(cg_famname_write(name.c_str()));
  }
}

inline void link(int file, int zone, const Grid& grid, const Patch& p, int number,
                 const RawCgns& way, bool general, bool wrong) {
  const std::array<cgsize_t, 6> range = nodes(p);
  std::array<cgsize_t, 6> donor{};
  std::array<int, 3> transform{};
  for (std::size_t a = 0; a < 3; ++a) {
    const auto d = std::size_t(p.link->axis[a]);
    transform[d] = p.link->sign[a] * int(a + 1);
    for (const std::size_t end : {0u, 3u}) // the node low of cell n, or high of its image
      donor[a + end] = p.link->offset[a] + p.link->sign[a] * (range[d + end] - 1) +
                       (p.link->sign[a] < 0 ? 2 : 1);
  }
  const std::string name = "link" + std::to_string(number);
  const std::string& other = grid.blocks[std::size_t(p.link->block)].name;
  int id = 0;
  if (general) {
    ok(cg_conn_write(file, 1, zone, name.c_str(), CGNS_ENUMV(Vertex), CGNS_ENUMV(Abutting),
                     CGNS_ENUMV(PointRange), 2, range.data(), other.c_str(), CGNS_ENUMV(Structured),
                     CGNS_ENUMV(PointListDonor), CGNS_ENUMV(Integer), 0, nullptr, &id));
    return;
  }
  if (wrong)
    transform[1] = -transform[1];
  ok(cg_1to1_write(file, 1, zone, name.c_str(), other.c_str(), range.data(), donor.data(),
                   transform.data(), &id));
  if (p.link->shift == Vec3{})
    return;
  const float s = way.translation_sign;
  const std::array<float, 3> centre{}, angle{way.rotation, 0, 0},
      translation{s * float(p.link->shift.x), s * float(p.link->shift.y),
                  s * float(p.link->shift.z)};
  ok(cg_1to1_periodic_write(file, 1, zone, id, centre.data(), angle.data(), translation.data()));
}

inline void coordinates(int file, int zone, const GridBlock& block, const RawCgns& way) {
  for (int d = 0; d < 3; ++d) {
    std::vector<double> values;
    for (int k = 0; k <= block.cells[2]; ++k)
      for (int j = 0; j <= block.cells[1]; ++j)
        for (int i = 0; i <= block.cells[0]; ++i)
          values.push_back(block.node(i, j, k)[d]);
    const std::vector<float> single(values.begin(), values.end());
    const std::string name = std::string("Coordinate") + "XYZ"[d];
    int id = 0;
    ok(cg_coord_write(file, 1, zone,
                      way.single_precision ? CGNS_ENUMV(RealSingle) : CGNS_ENUMV(RealDouble),
                      name.c_str(),
                      way.single_precision ? static_cast<const void*>(single.data())
                                           : static_cast<const void*>(values.data()),
                      &id));
  }
}

} // namespace raw

/// Rank 0 writes; all wait for it. Blocks must have names of their own.
inline void write_raw(const std::string& path, const Grid& grid, const RawCgns& way = {}) {
  if (rank_here() == 0) {
    int file = 0, base = 0;
    cg_set_file_type(CG_FILE_HDF5);
    raw::ok(cg_open(path.c_str(), CG_MODE_WRITE, &file));
    raw::ok(cg_base_write(file, "Base", 3, 3, &base));
    if (way.units) {
      raw::ok(cg_goto(file, base, "end"));
      raw::ok(cg_dataclass_write(CGNS_ENUMV(Dimensional)));
      raw::ok(cg_units_write(CGNS_ENUMV(Kilogram), way.unit, CGNS_ENUMV(Second), CGNS_ENUMV(Kelvin),
                             CGNS_ENUMV(Radian)));
    }
    for (int b = 0; b < int(grid.blocks.size()); ++b) {
      const GridBlock& block = grid.blocks[std::size_t(b)];
      std::array<cgsize_t, 9> size{};
      for (std::size_t d = 0; d < 3; ++d)
        size[d] = block.cells[d] + 1, size[d + 3] = block.cells[d];
      int zone = 0;
      raw::ok(cg_zone_write(file, base, block.name.c_str(), size.data(), CGNS_ENUMV(Structured),
                            &zone));
      raw::coordinates(file, zone, block, way);
      int links = 0, boundaries = 0;
      for (const Patch& p : block.patches)
        if (p.link) {
          const bool first = links++ == 0;
          if (!(first && way.skipped_link == b))
            raw::link(file, zone, grid, p, links, way, first && way.general_link == b,
                      first && way.wrong_transform == b);
        } else if (const bool first = boundaries++ == 0; !(first && way.skipped_boundary == b)) {
          raw::boundary(file, zone, grid, p, boundaries, way);
        }
    }
    if (way.more)
      way.more(file, base);
    raw::ok(cg_close(file));
  }
  MPI_Barrier(MPI_COMM_WORLD);
}

} // namespace granflux::cfd::testing
