// SPDX-FileCopyrightText: 2026 The GranFlux developers
// SPDX-License-Identifier: BSD-3-Clause
#include <fstream>
#include <random>

#include <granflux/cfd/annulus_grid.hpp>
#include <granflux/cfd/cgns_reader.hpp>
#include <granflux/cfd/cgns_writer.hpp>
#include <granflux/cfd/cylinder_grid.hpp>

#include "bent_cube.hpp"
#include "expect_config_error.hpp"
#include "raw_cgns.hpp"
#include "reoriented.hpp"
#include "same_geometry.hpp"

using namespace granflux;
using namespace granflux::cfd;
using namespace granflux::cfd::testing;
using granflux::test::config_error;

namespace {

Grid drum(int axis, bool periodic) {
  CylinderGrid c;
  c.frame = {axis, {0.1, 0.2, 0.3}};
  c.radius = 0.7, c.length = 0.37;
  c.core = 4, c.radial = 3, c.axial = 5, c.axial_blocks = 2, c.periodic_axis = periodic;
  return make_cylinder(c);
}

Grid gap() {
  AnnulusGrid a;
  a.inner_radius = 1, a.outer_radius = 2, a.length = 0.3;
  a.radial = 4, a.tangential = 12, a.axial = 2;
  a.arcs = {{"a name of more than thirty-two characters", 90, 270}, {"in/out", -90, 90}};
  return make_annulus(a);
}

void expect_equal(const Grid& read, const Grid& written) {
  EXPECT_EQ(read.boundaries.size(), written.boundaries.size());
  ASSERT_EQ(read.blocks.size(), written.blocks.size());
  for (std::size_t b = 0; b < read.blocks.size(); ++b) {
    const GridBlock &one = read.blocks[b], &two = written.blocks[b];
    ASSERT_EQ(one.cells, two.cells);
    for (int k = 0; k <= one.cells[2]; ++k)
      for (int j = 0; j <= one.cells[1]; ++j)
        for (int i = 0; i <= one.cells[0]; ++i)
          ASSERT_EQ(one.node(i, j, k), two.node(i, j, k));
    ASSERT_EQ(one.patches.size(), two.patches.size());
    for (const Patch& p : two.patches) { // links come first from a file
      const auto same = [&](const Patch& q) {
        if (q.side != p.side || q.cells.lo != p.cells.lo || q.cells.hi != p.cells.hi ||
            bool(q.link) != bool(p.link))
          return false;
        return !q.link || (q.link->block == p.link->block && q.link->axis == p.link->axis &&
                           q.link->sign == p.link->sign && q.link->offset == p.link->offset &&
                           norm(q.link->shift - p.link->shift) < 1e-15);
      };
      EXPECT_EQ(std::count_if(one.patches.begin(), one.patches.end(), same), 1) << "block " << b;
    }
  }
}

struct Fields {
  BlockFields values;
  explicit Fields(const Mesh& mesh) : values(make_fields(mesh, 1.5)) {}
};

} // namespace

TEST(CgnsReader, ReadsBackWhatTheWriterWrote) {
  const RankFolder folder;
  int ranks = 1;
  MPI_Comm_size(MPI_COMM_WORLD, &ranks);
  for (const Grid& grid : {drum(0, false), drum(1, true), drum(2, true), gap()}) {
    const Grid split = split_for_ranks(grid, ranks);
    const Mesh mesh = make_mesh(split, MPI_COMM_WORLD);
    const Fields fields(mesh);
    CgnsWriter writer(mesh, (folder.path / "gas").string());
    const std::string name = writer.write(0.5, {}, {{"Share", &fields.values}});
    const Grid read = read_cgns_grid({name, "", std::nullopt}, MPI_COMM_WORLD);
    expect_equal(read, split);
    expect_same_geometry(grid, read);
  }
}

TEST(CgnsReader, BoundariesKeepTheirNamesWhereTheFormatTakesThem) {
  const RankFolder folder;
  const Mesh mesh = make_mesh(split_for_ranks(gap(), 4), MPI_COMM_WORLD);
  const Fields fields(mesh);
  CgnsWriter writer(mesh, (folder.path / "gas").string());
  const Grid read =
      read_cgns_grid({writer.write(0, {}, {{"Share", &fields.values}}), "", 1.}, MPI_COMM_WORLD);
  std::vector<std::string> names = read.boundaries;
  std::sort(names.begin(), names.end());
  EXPECT_EQ(names, (std::vector<std::string>{"Boundary1", "Boundary2", "high", "inner", "low"}));
}

// Zones counted in any of the 48 ways, half of them left-handed, with every kind of description.
TEST(CgnsReader, TakesZonesOfAnyOrientation) {
  const RankFolder folder;
  std::mt19937 random(17);
  const auto all = orientations();
  const std::string path = (folder.path / "cube.cgns").string();
  for (int n = 0; n < 12; ++n) {
    const Grid cube = bent_cube(n % 2 == 1);
    std::vector<Orientation> ways(8);
    for (Orientation& way : ways)
      way = all[random() % all.size()];
    RawCgns raw;
    raw.families = n % 3 != 0, raw.faces = n % 4 < 2, raw.translation_sign = n % 3 == 1 ? 1 : -1;
    write_raw(path, reoriented(cube, ways), raw);
    const Grid read = read_cgns_grid({path, "", std::nullopt}, MPI_COMM_WORLD);
    expect_same_geometry(cube, read);
    expect_links_meet(read, 1e-15);
    const Mesh one = make_mesh(cube, MPI_COMM_SELF), two = make_mesh(read, MPI_COMM_SELF);
    for (const std::string& name : one.boundaries)
      EXPECT_NEAR(boundary_area(one, name), boundary_area(two, name), 1e-13) << name;
    MPI_Barrier(MPI_COMM_WORLD);
  }
}

TEST(CgnsReader, UnitsAndPrecisionAreThoseOfTheFile) {
  const RankFolder folder;
  const std::string path = (folder.path / "cube.cgns").string();
  const Grid cube = bent_cube();
  RawCgns raw;
  raw.unit = CGNS_ENUMV(Millimeter), raw.single_precision = true;
  write_raw(path, cube, raw);
  const Grid read = read_cgns_grid({path, "", std::nullopt}, MPI_COMM_WORLD);
  const Mesh mesh = make_mesh(split_for_ranks(read, 1), MPI_COMM_SELF);
  EXPECT_NEAR(total_volume(mesh) / 1e-9, total_volume(make_mesh(cube, MPI_COMM_SELF)), 1e-6);
  EXPECT_EQ(config_error([&] {
              (void)read_cgns_grid({path, "", 1.}, MPI_COMM_WORLD);
            }),
            "[grid] file = \"" + path +
                "\": zone \"cube from (0, 0, 0)\": the file says that its unit of length is 0.001 "
                "m: [grid] scale = 1 contradicts it");

  MPI_Barrier(MPI_COMM_WORLD);
  raw.units = false, raw.single_precision = false;
  write_raw(path, cube, raw);
  EXPECT_EQ(config_error([&] {
              (void)read_cgns_grid({path, "", {}}, MPI_COMM_WORLD);
            }),
            "[grid] file = \"" + path +
                "\": zone \"cube from (0, 0, 0)\": the file does not tell the unit of its "
                "coordinates: [grid] scale must give it (m per unit; 1 for metres)");
  const Grid scaled = read_cgns_grid({path, "", 2.}, MPI_COMM_WORLD);
  EXPECT_EQ(scaled.blocks[7].node(1, 1, 1), 2 * cube.blocks[7].node(1, 1, 1));
}

TEST(CgnsReader, ARankReadsItsOwnBlocksOfALargerMesh) {
  const RankFolder folder;
  int ranks = 1;
  MPI_Comm_size(MPI_COMM_WORLD, &ranks);
  const std::string path = (folder.path / "cube.cgns").string();
  const Grid cube = bent_cube(true);
  write_raw(path, cube);
  const Grid read = read_cgns_grid({path, "Base", {}}, MPI_COMM_WORLD);
  const Mesh mesh = make_mesh(split_for_ranks(read, ranks), MPI_COMM_WORLD);
  EXPECT_NEAR(total_volume(mesh), total_volume(make_mesh(cube, MPI_COMM_SELF)), 1e-13);
  expect_ghosts_follow(mesh);
}

namespace {

/// Message for the bent cube written in some way, without the file's name.
std::string refusal(const RawCgns& raw, bool periodic = false, const std::string& base = "") {
  const RankFolder folder;
  const std::string path = (folder.path / "cube.cgns").string();
  write_raw(path, bent_cube(periodic), raw);
  const std::string message = config_error([&] {
    (void)make_mesh(read_cgns_grid({path, base, {}}, MPI_COMM_WORLD), MPI_COMM_SELF);
  });
  const std::string start = "[grid] file = \"" + path + "\": ";
  return message.starts_with(start) ? message.substr(start.size()) : message;
}

} // namespace

TEST(CgnsReaderRefuses, FacesWithNeitherConditionNorConnection) {
  RawCgns raw;
  raw.skipped_link = 2;
  EXPECT_EQ(refusal(raw), "zone \"cube from (0, 2, 0)\": 9 faces have neither a boundary condition "
                          "nor a connection, within nodes (5, 1, 1) to (5, 4, 4)");
  raw = {};
  raw.skipped_boundary = 0;
  EXPECT_EQ(refusal(raw), "zone \"cube from (0, 0, 0)\": 6 faces have neither a boundary condition "
                          "nor a connection, within nodes (1, 1, 1) to (1, 3, 4)");
}

TEST(CgnsReaderRefuses, ConnectionsThatAreNotNodeToNode) {
  RawCgns raw;
  raw.general_link = 0;
  EXPECT_EQ(refusal(raw),
            "zone \"cube from (0, 0, 0)\": connection \"link1\" to \"cube from (4, 0, "
            "0)\" is of the general kind (Abutting): zones must be joined node to "
            "node, by GridConnectivity1to1");
}

TEST(CgnsReaderRefuses, AConnectionWhoseRangesDoNotMatch) {
  RawCgns raw;
  raw.wrong_transform = 0;
  const std::string message = refusal(raw);
  EXPECT_TRUE(
      message.starts_with("zone \"cube from (0, 0, 0)\": connection \"link1\": nodes (5, 1, "
                          "1) to (5, 3, 4) and the donor's (1, 1, 1) to (1, 3, 4) do not "
                          "match under transform [1, -2, 3]"))
      << message;
}

TEST(CgnsReaderRefuses, RotationAndAWrongTranslation) {
  RawCgns raw;
  raw.rotation = 90;
  EXPECT_NE(refusal(raw, true).find("it is periodic by rotation: only translation is possible"),
            std::string::npos);
  raw = {};
  raw.translation_sign = -1.5;
  EXPECT_NE(refusal(raw, true).find("but its nodes are"), std::string::npos) << refusal(raw, true);
}

TEST(CgnsReaderRefuses, UnstructuredZonesAndFlatBases) {
  RawCgns raw;
  raw.more = [](int file, int base) {
    const std::array<cgsize_t, 3> size{8, 1, 0};
    int zone = 0;
    EXPECT_EQ(cg_zone_write(file, base, "tets", size.data(), CGNS_ENUMV(Unstructured), &zone),
              CG_OK);
  };
  EXPECT_EQ(refusal(raw), "zone \"tets\": it is unstructured: only structured zones can be read");
  raw.more = [](int file, int) {
    int base = 0;
    EXPECT_EQ(cg_base_write(file, "Flat", 2, 3, &base), CG_OK);
  };
  EXPECT_EQ(refusal(raw), "it has several bases: [grid] base must name one; its bases are: Base, "
                          "Flat");
  EXPECT_EQ(refusal(raw, false, "Round"), "it has no base \"Round\"; its bases are: Base, Flat");
  EXPECT_EQ(refusal(raw, false, "Flat"),
            "base \"Flat\" has cells of 2 dimensions in a space of 3: both must be 3");
}

TEST(CgnsReaderRefuses, ConditionsThatAreNoRectangleOfFaces) {
  const auto with_condition = [](std::array<cgsize_t, 6> range) {
    RawCgns raw;
    raw.more = [range](int file, int base) {
      int condition = 0;
      EXPECT_EQ(cg_boco_write(file, base, 1, "odd", CGNS_ENUMV(BCWall), CGNS_ENUMV(PointRange), 2,
                              range.data(), &condition),
                CG_OK);
    };
    return refusal(raw);
  };
  const std::string zone = "zone \"cube from (0, 0, 0)\": boundary condition \"odd\": nodes ";
  EXPECT_EQ(with_condition({2, 1, 1, 2, 3, 4}),
            zone + "(2, 1, 1) to (2, 3, 4) lie inside the zone, not on a side of it");
  EXPECT_EQ(with_condition({1, 1, 1, 1, 1, 4}),
            zone + "(1, 1, 1) to (1, 1, 4) are no rectangle of faces: one index must be constant, "
                   "the others not");
  const std::string twice = with_condition({1, 1, 1, 1, 3, 4});
  EXPECT_NE(twice.find("is in two patches"), std::string::npos) << twice;

  RawCgns raw;
  raw.more = [](int file, int base) {
    const std::array<cgsize_t, 6> points{1, 1, 1, 1, 2, 1};
    int condition = 0;
    EXPECT_EQ(cg_boco_write(file, base, 1, "list", CGNS_ENUMV(BCWall), CGNS_ENUMV(PointList), 2,
                            points.data(), &condition),
              CG_OK);
  };
  EXPECT_EQ(refusal(raw), "zone \"cube from (0, 0, 0)\": boundary condition \"list\" is given as a "
                          "PointList: only a PointRange can be read");
}

TEST(CgnsReaderRefuses, FilesThatAreNone) {
  const RankFolder folder;
  const auto message = [](const std::string& path) {
    const std::string text = config_error([&] {
      (void)read_cgns_grid({path, "", {}}, MPI_COMM_WORLD);
    });
    return text.substr(text.find("\": ") + 3);
  };
  EXPECT_EQ(message("no/such/file.cgns"), "cannot be read: No such file or directory");
  const std::string text_file = (folder.path / "text.cgns").string();
  const std::string cut_file = (folder.path / "cut.cgns").string();
  const std::string empty_file = (folder.path / "empty.cgns").string();
  write_raw(cut_file, bent_cube());
  if (rank_here() == 0) {
    std::ofstream(text_file) << "title = \"not a grid\"\n";
    std::ofstream{empty_file};
    std::filesystem::resize_file(cut_file, std::filesystem::file_size(cut_file) / 2);
  }
  MPI_Barrier(MPI_COMM_WORLD);
  EXPECT_EQ(message(text_file), "it is no CGNS file");
  EXPECT_EQ(message(empty_file), "it is no CGNS file");
  EXPECT_EQ(message(cut_file), "it is no CGNS file");
}

TEST(CgnsReaderRefuses, AFileThatOnlyOneRankCanRead) {
  const RankFolder folder;
  const std::string path = (folder.path / "cube.cgns").string();
  write_raw(path, bent_cube());
  const CgnsGrid grid{rank_here() == 0 ? path : path + ".elsewhere", "", {}};
  int ranks = 1;
  MPI_Comm_size(MPI_COMM_WORLD, &ranks);
  if (ranks == 1)
    EXPECT_NO_THROW((void)read_cgns_grid(grid, MPI_COMM_WORLD));
  else
    EXPECT_NE(config_error([&] { (void)read_cgns_grid(grid, MPI_COMM_WORLD); }).find("elsewhere"),
              std::string::npos);
}
