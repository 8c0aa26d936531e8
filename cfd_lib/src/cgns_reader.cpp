// SPDX-FileCopyrightText: 2026 The GranFlux developers
// SPDX-License-Identifier: BSD-3-Clause
#include <granflux/cfd/cgns_reader.hpp>

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <cstdlib>
#include <fstream>
#include <limits>
#include <memory>
#include <mutex>
#include <system_error>
#include <vector>

#include <cgnslib.h>
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <granflux/cfd/error.hpp>
#include <granflux/cfd/join_blocks.hpp>

#include "throw_alike.hpp"

namespace granflux::cfd {

namespace {

constexpr std::size_t name_size = 33; ///< of the library's buffers for names

/// Indices count from 1 in the file, from 0 here.
using FileRange = std::array<cgsize_t, 6>;

/// A file that is open for reading. The library has one state for all threads.
class CgnsFile {
public:
  explicit CgnsFile(const std::string& path) : path_(path) {
    errno = 0;
    if (!std::ifstream(path, std::ios::binary))
      fail(fmt::format("cannot be read: {}", std::generic_category().message(errno)));
    int type = 0;
    if (cg_is_cgns(path.c_str(), &type) != CG_OK)
      fail("it is no CGNS file");
    require(cg_open(path.c_str(), CG_MODE_READ, &file_), "open");
  }
  CgnsFile(const CgnsFile&) = delete;
  CgnsFile& operator=(const CgnsFile&) = delete;
  ~CgnsFile() { cg_close(file_); }

  [[nodiscard]] int id() const { return file_; }
  [[noreturn]] void fail(const std::string& why) const {
    throw ConfigError(fmt::format("[grid] file = \"{}\": {}", path_, why));
  }
  void require(int status, const std::string& what) const {
    if (status != CG_OK)
      fail(fmt::format("cannot {}: {}", what, cg_get_error()));
  }
  std::mutex reading;

private:
  std::string path_;
  int file_ = 0;
};

/// The nodes of one zone in metres, read a plane of constant k at a time.
class ZoneNodes {
public:
  ZoneNodes(std::shared_ptr<CgnsFile> file, int base, int zone, const Index3& nodes, double scale)
      : file_(std::move(file)), base_(base), zone_(zone), nodes_(nodes), scale_(scale),
        planes_(std::size_t(nodes[2])) {}

  /// By the file's order of indices, from 0.
  const Vec3& operator()(int i, int j, int k) {
    Plane& plane = planes_[std::size_t(k)];
    std::call_once(plane.read, [&] { read(k, plane.nodes); });
    return plane.nodes[std::size_t(i + nodes_[0] * j)];
  }

private:
  struct Plane {
    std::once_flag read;
    std::vector<Vec3> nodes;
  };

  void read(int k, std::vector<Vec3>& plane) const {
    const std::lock_guard lock(file_->reading);
    const std::array<cgsize_t, 3> first{1, 1, k + 1}, last{nodes_[0], nodes_[1], k + 1};
    const std::size_t count = std::size_t(nodes_[0]) * std::size_t(nodes_[1]);
    std::vector<double> values(count);
    plane.resize(count);
    for (int d = 0; d < 3; ++d) {
      const std::string name = std::string("Coordinate") + "XYZ"[d];
      file_->require(cg_coord_read(file_->id(), base_, zone_, name.c_str(), CGNS_ENUMV(RealDouble),
                                   first.data(), last.data(), values.data()),
                     "read " + name);
      for (std::size_t n = 0; n < count; ++n)
        plane[n][d] = scale_ * values[n];
    }
  }

  std::shared_ptr<CgnsFile> file_;
  int base_, zone_;
  Index3 nodes_;
  double scale_;
  std::vector<Plane> planes_;
};

struct Zone {
  std::string name;
  Index3 cells{};
  std::shared_ptr<ZoneNodes> nodes;
  bool turned = false; ///< k counts backwards from the file

  /// Node of the grid from one of the file, or the reverse.
  [[nodiscard]] Index3 order(const Index3& n) const {
    return {n[0], n[1], turned ? cells[2] - n[2] : n[2]};
  }
  [[nodiscard]] Vec3 node(const Index3& n) const {
    const Index3 f = order(n);
    return (*nodes)(f[0], f[1], f[2]);
  }
};

/// Reads the structure of one base into a grid.
class GridReader {
public:
  GridReader(const CgnsGrid& grid, std::shared_ptr<CgnsFile> file)
      : description_(grid), file_(std::move(file)), base_(find_base()) {}

  Grid read() {
    int count = 0;
    require(cg_nzones(file_->id(), base_, &count), "count the zones");
    if (count == 0)
      file_->fail("it has no zones");
    for (int z = 1; z <= count; ++z)
      zones_.push_back(read_zone(z));
    for (int z = 1; z <= count; ++z) {
      const Zone& zone = zones_[std::size_t(z - 1)];
      grid_.blocks.push_back({zone.name,
                              zone.cells,
                              [zone](int i, int j, int k) {
                                return zone.node({i, j, k});
                              },
                              {}});
      read_connections(z);
      read_conditions(z);
      check_covered(z);
    }
    return std::move(grid_);
  }

private:
  void require(int status, const std::string& what) const { file_->require(status, what); }
  [[noreturn]] void fail(int z, const std::string& why) const {
    file_->fail(fmt::format("zone \"{}\": {}", zones_[std::size_t(z - 1)].name, why));
  }

  [[nodiscard]] int find_base() const {
    int count = 0;
    require(cg_nbases(file_->id(), &count), "count the bases");
    std::vector<std::string> names;
    int found = count == 1 && description_.base.empty() ? 1 : 0;
    for (int b = 1; b <= count; ++b) {
      std::array<char, name_size> name{};
      int cell_dimension = 0, space_dimension = 0;
      require(cg_base_read(file_->id(), b, name.data(), &cell_dimension, &space_dimension),
              "read its bases");
      names.emplace_back(name.data());
      if (names.back() == description_.base)
        found = b;
      if (found == b && (cell_dimension != 3 || space_dimension != 3))
        file_->fail(
            fmt::format("base \"{}\" has cells of {} dimensions in a space of {}: both must "
                        "be 3",
                        names.back(), cell_dimension, space_dimension));
    }
    if (count == 0)
      file_->fail("it has no base");
    if (found == 0)
      file_->fail(fmt::format("{}; its bases are: {}",
                              description_.base.empty()
                                  ? "it has several bases: [grid] base must name one"
                                  : "it has no base \"" + description_.base + "\"",
                              fmt::join(names, ", ")));
    return found;
  }

  Zone read_zone(int z) const {
    std::array<char, name_size> name{};
    std::array<cgsize_t, 9> size{};
    ZoneType_t type{};
    require(cg_zone_type(file_->id(), base_, z, &type), "read the zones");
    require(cg_zone_read(file_->id(), base_, z, name.data(), size.data()), "read the zones");
    const auto zone_fails = [&](const std::string& why) {
      file_->fail(fmt::format("zone \"{}\": {}", name.data(), why));
    };
    if (type != CGNS_ENUMV(Structured))
      zone_fails("it is unstructured: only structured zones can be read");
    Zone zone{name.data(), {}, nullptr, false};
    for (std::size_t d = 0; d < 3; ++d) {
      if (size[d] < 2 || size[d] > std::numeric_limits<int>::max() / 4)
        zone_fails(fmt::format("{} nodes along {}: at least 2 are needed", size[d], "ijk"[d]));
      zone.cells[d] = int(size[d]) - 1;
    }
    check_coordinates(z, name.data());
    zone.nodes = std::make_shared<ZoneNodes>(
        file_, base_, z, Index3{zone.cells[0] + 1, zone.cells[1] + 1, zone.cells[2] + 1},
        metres_per_unit(z, name.data()));
    zone.turned = left_handed(zone);
    return zone;
  }

  void check_coordinates(int z, const char* name) const {
    int count = 0;
    require(cg_ncoords(file_->id(), base_, z, &count), "count the coordinates");
    std::vector<std::string> found;
    for (int c = 1; c <= count; ++c) {
      std::array<char, name_size> title{};
      DataType_t type{};
      require(cg_coord_info(file_->id(), base_, z, c, &type, title.data()), "read coordinates");
      found.emplace_back(title.data());
    }
    for (const char* title : {"CoordinateX", "CoordinateY", "CoordinateZ"})
      if (std::find(found.begin(), found.end(), title) == found.end())
        file_->fail(fmt::format("zone \"{}\": it has no {}; it has: {}", name, title,
                                fmt::join(found, ", ")));
  }

  /// Unit of length of the coordinates, as the nearest node above them tells it.
  [[nodiscard]] std::optional<double> unit_in_file(int z) const {
    const auto at_current = []() -> std::optional<double> {
      DataClass_t data{};
      if (cg_dataclass_read(&data) == CG_OK && data != CGNS_ENUMV(Dimensional))
        return std::numeric_limits<double>::quiet_NaN(); // numbers without a unit
      MassUnits_t mass{};
      LengthUnits_t length{};
      TimeUnits_t time{};
      TemperatureUnits_t temperature{};
      AngleUnits_t angle{};
      if (cg_units_read(&mass, &length, &time, &temperature, &angle) != CG_OK)
        return {};
      switch (length) {
      case CGNS_ENUMV(Meter):
        return 1;
      case CGNS_ENUMV(Centimeter):
        return 0.01;
      case CGNS_ENUMV(Millimeter):
        return 0.001;
      case CGNS_ENUMV(Foot):
        return 0.3048;
      case CGNS_ENUMV(Inch):
        return 0.0254;
      default:
        return {};
      }
    };
    const int f = file_->id();
    std::optional<double> unit;
    if (cg_goto(f, base_, "Zone_t", z, "GridCoordinates_t", 1, "DataArray_t", 1, "end") == CG_OK)
      unit = at_current();
    if (!unit && cg_goto(f, base_, "Zone_t", z, "GridCoordinates_t", 1, "end") == CG_OK)
      unit = at_current();
    if (!unit && cg_goto(f, base_, "Zone_t", z, "end") == CG_OK)
      unit = at_current();
    if (!unit && cg_goto(f, base_, "end") == CG_OK)
      unit = at_current();
    return unit && std::isnan(*unit) ? std::nullopt : unit;
  }

  [[nodiscard]] double metres_per_unit(int z, const char* name) const {
    const std::optional<double> told = unit_in_file(z);
    const std::optional<double>& scale = description_.scale;
    if (!told && !scale)
      file_->fail(fmt::format("zone \"{}\": the file does not tell the unit of its coordinates: "
                              "[grid] scale must give it (m per unit; 1 for metres)",
                              name));
    if (told && scale && std::abs(*told - *scale) > 1e-12 * *told)
      file_->fail(fmt::format("zone \"{}\": the file says that its unit of length is {} m: [grid] "
                              "scale = {} contradicts it",
                              name, *told, *scale));
    return told ? *told : *scale;
  }

  /// By a cell in the middle: those at the edges may have collapsed.
  static bool left_handed(const Zone& zone) {
    const Index3 c{zone.cells[0] / 2, zone.cells[1] / 2, zone.cells[2] / 2};
    std::array<Vec3, 3> across{};
    for (int corner = 0; corner < 8; ++corner) {
      const Vec3 x =
          zone.node({c[0] + (corner & 1), c[1] + (corner >> 1 & 1), c[2] + (corner >> 2)});
      for (int d = 0; d < 3; ++d)
        across[std::size_t(d)] += (corner >> d & 1 ? 1. : -1.) * x;
    }
    return dot(cross(across[0], across[1]), across[2]) < 0;
  }

  /// Corner of a range of nodes in the grid's order, from 0.
  static Index3 corner(const Zone& zone, const FileRange& range, bool end) {
    const std::size_t first = end ? 3 : 0;
    return zone.order(
        {int(range[first]) - 1, int(range[first + 1]) - 1, int(range[first + 2]) - 1});
  }

  static std::string text_of(const FileRange& r) {
    return fmt::format("({}, {}, {}) to ({}, {}, {})", r[0], r[1], r[2], r[3], r[4], r[5]);
  }

  /// The faces between two corners of a rectangle of nodes on a side of a zone.
  [[nodiscard]] Patch patch_between(int z, const Index3& a, const Index3& b,
                                    const std::string& whose, const FileRange& range) const {
    const Zone& zone = zones_[std::size_t(z - 1)];
    Patch patch;
    int flat = 0;
    for (std::size_t d = 0; d < 3; ++d) {
      const int low = std::min(a[d], b[d]), high = std::max(a[d], b[d]);
      const int n = zone.cells[d];
      if (low < 0 || high > n)
        fail(z,
             fmt::format("{}: nodes {} lie outside the zone of {} x {} x {} nodes", whose,
                         text_of(range), zone.cells[0] + 1, zone.cells[1] + 1, zone.cells[2] + 1));
      patch.cells.lo[d] = low, patch.cells.hi[d] = high;
      if (low < high)
        continue;
      ++flat;
      patch.side = {int(d), low == n};
      if (low != 0 && low != n)
        fail(z, fmt::format("{}: nodes {} lie inside the zone, not on a side of it", whose,
                            text_of(range)));
      patch.cells.lo[d] = low == n ? n - 1 : 0;
      patch.cells.hi[d] = patch.cells.lo[d] + 1;
    }
    if (flat != 1)
      fail(z, fmt::format("{}: nodes {} are no rectangle of faces: one index must be constant, the "
                          "others not",
                          whose, text_of(range)));
    return patch;
  }

  void read_connections(int z) {
    const int f = file_->id();
    int general = 0, holes = 0, count = 0;
    require(cg_nconns(f, base_, z, &general), "count the connections");
    require(cg_nholes(f, base_, z, &holes), "count the overset holes");
    if (general > 0)
      refuse_general(z);
    if (holes > 0)
      fail(z, "it has overset holes: zones must be joined one to one");
    require(cg_n1to1(f, base_, z, &count), "count the one-to-one connections");
    for (int c = 1; c <= count; ++c) {
      std::array<char, name_size> name{}, donor_name{};
      FileRange range{}, donor_range{};
      Transform transform{};
      require(cg_1to1_read(f, base_, z, c, name.data(), donor_name.data(), range.data(),
                           donor_range.data(), transform.data()),
              "read the one-to-one connections");
      add_link(z, c, name.data(), donor_name.data(), range, donor_range, transform);
    }
  }

  [[noreturn]] void refuse_general(int z) const {
    std::array<char, name_size> name{}, donor{};
    GridLocation_t location{};
    GridConnectivityType_t type{};
    PointSetType_t points{}, donor_points{};
    cgsize_t count = 0, donor_count = 0;
    ZoneType_t donor_zone{};
    DataType_t data{};
    require(cg_conn_info(file_->id(), base_, z, 1, name.data(), &location, &type, &points, &count,
                         donor.data(), &donor_zone, &donor_points, &data, &donor_count),
            "read the connections");
    fail(z, fmt::format("connection \"{}\" to \"{}\" is of the general kind ({}): zones must be "
                        "joined node to node, by GridConnectivity1to1",
                        name.data(), donor.data(), cg_GridConnectivityTypeName(type)));
  }

  void add_link(int z, int c, const std::string& name, const std::string& donor_name,
                const FileRange& range, const FileRange& donor_range, Transform transform) {
    const std::string whose = fmt::format("connection \"{}\"", name);
    const auto donor = std::find_if(zones_.begin(), zones_.end(),
                                    [&](const Zone& other) { return other.name == donor_name; });
    if (donor == zones_.end())
      fail(z, fmt::format("{}: the base has no zone \"{}\"", whose, donor_name));
    std::array<bool, 3> taken{};
    for (const int t : transform)
      if (std::abs(t) >= 1 && std::abs(t) <= 3)
        taken[std::size_t(std::abs(t) - 1)] = true;
    if (!taken[0] || !taken[1] || !taken[2])
      fail(z, fmt::format("{}: transform [{}] is none: each of 1, 2, 3 must be there once, with a "
                          "sign",
                          whose, fmt::join(transform, ", ")));
    const Zone& zone = zones_[std::size_t(z - 1)];
    for (std::size_t d = 0; d < 3; ++d) {
      if (zone.turned && d == 2)
        transform[d] = -transform[d];
      if (donor->turned && std::abs(transform[d]) == 3)
        transform[d] = -transform[d];
    }
    const Index3 begin = corner(zone, range, false), end = corner(zone, range, true);
    const Index3 donor_begin = corner(*donor, donor_range, false);
    Patch patch = patch_between(z, begin, end, whose, range);
    patch.link = make_link(int(donor - zones_.begin()), begin, donor_begin, transform);
    for (std::size_t d = 0; d < 3; ++d) {
      const auto a = std::size_t(std::abs(transform[d]) - 1);
      const int expected = donor_begin[a] + (transform[d] < 0 ? -1 : 1) * (end[d] - begin[d]);
      if (expected != corner(*donor, donor_range, true)[a])
        fail(z,
             fmt::format("{}: nodes {} and the donor's {} do not match under transform [{}]", whose,
                         text_of(range), text_of(donor_range), fmt::join(transform, ", ")));
    }
    patch.link->shift = shift_of(z, c, whose, zone.node(begin), donor->node(donor_begin));
    grid_.blocks.back().patches.push_back(patch);
  }

  /// Of a periodic connection. The file holds it in single precision, so the nodes give it.
  [[nodiscard]] Vec3 shift_of(int z, int c, const std::string& whose, const Vec3& here,
                              const Vec3& there) const {
    std::array<float, 3> centre{}, angle{}, translation{};
    const int status = cg_1to1_periodic_read(file_->id(), base_, z, c, centre.data(), angle.data(),
                                             translation.data());
    if (status == CG_NODE_NOT_FOUND)
      return {};
    require(status, "read whether " + whose + " is periodic");
    if (angle != std::array<float, 3>{})
      fail(z, fmt::format("{}: it is periodic by rotation: only translation is possible", whose));
    const double unit = metres_per_unit(z, zones_[std::size_t(z - 1)].name.c_str());
    const Vec3 told = unit * Vec3{translation[0], translation[1], translation[2]};
    const Vec3 found = here - there;
    // From this side to the other by the standard; some programs write the opposite.
    const double error = std::min(norm(found + told), norm(found - told));
    if (error > 1e-4 * norm(told))
      fail(z, fmt::format("{}: it is periodic by ({}, {}, {}) m, but its nodes are ({}, {}, {}) m "
                          "apart",
                          whose, told.x, told.y, told.z, -found.x, -found.y, -found.z));
    return found;
  }

  void read_conditions(int z) {
    const int f = file_->id();
    int count = 0;
    require(cg_nbocos(f, base_, z, &count), "count the boundary conditions");
    for (int c = 1; c <= count; ++c) {
      std::array<char, name_size> name{};
      BCType_t type{};
      PointSetType_t points{};
      cgsize_t number = 0, normals = 0;
      std::array<int, 3> normal{};
      DataType_t normal_type{};
      int data_sets = 0;
      require(cg_boco_info(f, base_, z, c, name.data(), &type, &points, &number, normal.data(),
                           &normals, &normal_type, &data_sets),
              "read the boundary conditions");
      const std::string whose = fmt::format("boundary condition \"{}\"", name.data());
      if (points != CGNS_ENUMV(PointRange) || number != 2)
        fail(z, fmt::format("{} is given as a {}: only a PointRange can be read", whose,
                            cg_PointSetTypeName(points)));
      FileRange range{};
      require(cg_boco_read(f, base_, z, c, range.data(), nullptr), "read " + whose);
      add_boundary(z, c, whose, range, boundary_name(z, c, name.data()));
    }
  }

  /// Its family, or its own.
  [[nodiscard]] std::string boundary_name(int z, int c, const char* own) const {
    std::array<char, 1024> family{};
    require(cg_goto(file_->id(), base_, "Zone_t", z, "ZoneBC_t", 1, "BC_t", c, "end"),
            "go to a boundary condition");
    return cg_famname_read(family.data()) == CG_OK && family[0] != '\0' ? family.data() : own;
  }

  void add_boundary(int z, int c, const std::string& whose, FileRange range,
                    const std::string& name) {
    GridLocation_t location{};
    require(cg_boco_gridlocation_read(file_->id(), base_, z, c, &location),
            "read where " + whose + " lies");
    if (location != CGNS_ENUMV(Vertex))
      range = nodes_of_faces(z, whose, range, location);
    const Zone& zone = zones_[std::size_t(z - 1)];
    Patch patch =
        patch_between(z, corner(zone, range, false), corner(zone, range, true), whose, range);
    const auto found = std::find(grid_.boundaries.begin(), grid_.boundaries.end(), name);
    patch.boundary = int(found - grid_.boundaries.begin());
    if (found == grid_.boundaries.end())
      grid_.boundaries.push_back(name);
    grid_.blocks.back().patches.push_back(patch);
  }

  /// A range of faces reaches to the nodes one further along the side.
  [[nodiscard]] FileRange nodes_of_faces(int z, const std::string& whose, FileRange range,
                                         GridLocation_t location) const {
    int normal = -1;
    if (location == CGNS_ENUMV(IFaceCenter))
      normal = 0;
    if (location == CGNS_ENUMV(JFaceCenter))
      normal = 1;
    if (location == CGNS_ENUMV(KFaceCenter))
      normal = 2;
    for (int d = 0; d < 3 && location == CGNS_ENUMV(FaceCenter); ++d)
      if (range[std::size_t(d)] == range[std::size_t(d + 3)] &&
          (range[std::size_t(d)] == 1 ||
           range[std::size_t(d)] == zones_[std::size_t(z - 1)].cells[std::size_t(d)] + 1))
        normal = normal < 0 ? d : 3; // 3: more than one, as of a single face
    if (normal < 0 || normal > 2)
      fail(z, fmt::format("{}: its range {} is of {}: only vertices and faces of one direction can "
                          "be read",
                          whose, text_of(range), cg_GridLocationName(location)));
    for (int d = 0; d < 3; ++d)
      if (d != normal)
        ++(range[std::size_t(d)] > range[std::size_t(d + 3)] ? range[std::size_t(d)]
                                                             : range[std::size_t(d + 3)]);
    return range;
  }

  /// Names the rectangle of faces, by the file's nodes, that have neither condition nor connection.
  void check_covered(int z) const {
    const Zone& zone = zones_[std::size_t(z - 1)];
    const GridBlock& block = grid_.blocks.back();
    for (int d = 0; d < 3; ++d)
      for (const bool high : {false, true}) {
        const Side side{d, high};
        const IndexBox faces = layer(block.cells, side);
        IndexBox bare{block.cells, {0, 0, 0}};
        std::int64_t count = 0;
        for (int k = faces.lo[2]; k < faces.hi[2]; ++k)
          for (int j = faces.lo[1]; j < faces.hi[1]; ++j)
            for (int i = faces.lo[0]; i < faces.hi[0]; ++i) {
              const Index3 cell{i, j, k};
              if (std::any_of(block.patches.begin(), block.patches.end(), [&](const Patch& p) {
                    return p.side == side && p.cells.contains(cell);
                  }))
                continue;
              ++count;
              for (std::size_t e = 0; e < 3; ++e) {
                bare.lo[e] = std::min(bare.lo[e], cell[e]);
                bare.hi[e] = std::max(bare.hi[e], cell[e] + 1);
              }
            }
        if (count == 0)
          continue;
        bare.lo[std::size_t(d)] = bare.hi[std::size_t(d)] = high ? block.cells[std::size_t(d)] : 0;
        const Index3 a = zone.order(bare.lo), b = zone.order(bare.hi);
        FileRange range{};
        for (std::size_t e = 0; e < 3; ++e) {
          range[e] = std::min(a[e], b[e]) + 1;
          range[e + 3] = std::max(a[e], b[e]) + 1;
        }
        fail(z, fmt::format("{} faces have neither a boundary condition nor a connection, within "
                            "nodes {}",
                            count, text_of(range)));
      }
  }

  const CgnsGrid& description_;
  std::shared_ptr<CgnsFile> file_;
  int base_;
  std::vector<Zone> zones_;
  Grid grid_;
};

} // namespace

Grid read_cgns_grid(const CgnsGrid& grid, MPI_Comm comm) {
  Grid read;
  std::string error;
  try {
    read = GridReader(grid, std::make_shared<CgnsFile>(grid.file)).read();
  } catch (const ConfigError& e) {
    error = e.what();
  }
  throw_alike(comm, error);
  return read;
}

} // namespace granflux::cfd
