// SPDX-FileCopyrightText: 2026 The GranFlux developers
// SPDX-License-Identifier: BSD-3-Clause
#include <csignal>
#include <filesystem>
#include <gtest/gtest.h>
#include <sys/resource.h>

#include <cgnslib.h>

#include <granflux/cfd/box_mesh.hpp>
#include <granflux/cfd/cgns_writer.hpp>
#include <granflux/cfd/error.hpp>

#include "expect_config_error.hpp"
#include "rank_folder.hpp"

using granflux::NumericalError;
using granflux::Vec3;
using granflux::test::config_error;
using granflux::test::rank_here;
using granflux::test::RankFolder;
using namespace granflux::cfd;

namespace {

/// Stretched along y, four blocks.
Mesh box() {
  BoxGrid grid;
  grid.nodes = {uniform_nodes(-0.5, 1.0, 6), {0.0, 0.1, 0.3, 0.7, 1.5}, uniform_nodes(0, 2, 4)};
  grid.periodic = {true, true, true};
  grid.blocks = {2, 1, 2};
  return make_box_mesh(grid, MPI_COMM_WORLD);
}

double shape(const Vec3& x, int component) {
  return double(component + 1) + 10 * x.x - 3 * x.y * x.z;
}

struct Fields {
  BlockVectors velocity;
  BlockFields share;
};

Fields fields_on(const Mesh& mesh) {
  Fields fields{make_vectors(mesh), make_fields(mesh)};
  for (std::size_t b = 0; b < mesh.local.size(); ++b) {
    const Block& block = mesh.local[b];
    for (std::size_t c = 0; c < block.layout.size; ++c) {
      const auto at = std::ptrdiff_t(c);
      const Vec3 x{block.centre[0][at], block.centre[1][at], block.centre[2][at]};
      for (std::size_t d = 0; d < 3; ++d)
        fields.velocity[b][d][at] = shape(x, int(d));
      fields.share[b][at] = shape(x, 7);
    }
  }
  return fields;
}

/// One zone as the CGNS library reads it back.
struct Zone {
  std::array<std::vector<double>, 3> node;
  std::array<std::vector<double>, 4> value;
  Index3 cells{};
};

Zone read_zone(int file, int number) {
  Zone zone;
  char name[33];
  std::array<cgsize_t, 9> size{};
  EXPECT_EQ(cg_zone_read(file, 1, number, name, size.data()), CG_OK);
  std::array<cgsize_t, 3> first{1, 1, 1}, last_node{size[0], size[1], size[2]},
      last_cell{size[3], size[4], size[5]};
  zone.cells = {int(size[3]), int(size[4]), int(size[5])};
  for (std::size_t d = 0; d < 3; ++d) {
    zone.node[d].resize(std::size_t(size[0] * size[1] * size[2]));
    const std::string title = std::string("Coordinate") + "XYZ"[d];
    EXPECT_EQ(cg_coord_read(file, 1, number, title.c_str(), CGNS_ENUMV(RealDouble), first.data(),
                            last_node.data(), zone.node[d].data()),
              CG_OK);
  }
  GridLocation_t location{};
  EXPECT_EQ(cg_sol_info(file, 1, number, 1, name, &location), CG_OK);
  EXPECT_EQ(location, CGNS_ENUMV(CellCenter));
  const std::array<const char*, 4> titles{"VelocityX", "VelocityY", "VelocityZ", "Share"};
  for (std::size_t f = 0; f < 4; ++f) {
    zone.value[f].resize(std::size_t(size[3] * size[4] * size[5]));
    EXPECT_EQ(cg_field_read(file, 1, number, 1, titles[f], CGNS_ENUMV(RealDouble), first.data(),
                            last_cell.data(), zone.value[f].data()),
              CG_OK)
        << cg_get_error();
  }
  return zone;
}

double time_of(int file) {
  char name[33];
  int steps = 0;
  EXPECT_EQ(cg_biter_read(file, 1, name, &steps), CG_OK);
  EXPECT_EQ(steps, 1);
  EXPECT_EQ(cg_goto(file, 1, "BaseIterativeData_t", 1, "end"), CG_OK);
  double time = -1;
  EXPECT_EQ(cg_array_read(1, &time), CG_OK);
  return time;
}

/// Every cell's values against the exact field at the centre of the nodes in the file.
void check_zone(const Zone& zone) {
  const auto node = [&](int i, int j, int k) {
    const auto n = std::size_t(i + (zone.cells[0] + 1) * (j + (zone.cells[1] + 1) * k));
    return Vec3{zone.node[0][n], zone.node[1][n], zone.node[2][n]};
  };
  std::size_t cell = 0;
  for (int k = 0; k < zone.cells[2]; ++k)
    for (int j = 0; j < zone.cells[1]; ++j)
      for (int i = 0; i < zone.cells[0]; ++i, ++cell) {
        const Vec3 centre = 0.5 * (node(i, j, k) + node(i + 1, j + 1, k + 1));
        for (int d = 0; d < 3; ++d)
          EXPECT_NEAR(zone.value[std::size_t(d)][cell], shape(centre, d), 1e-12);
        EXPECT_NEAR(zone.value[3][cell], shape(centre, 7), 1e-12);
      }
}

} // namespace

TEST(CgnsWriter, FilesReadBackWithTheirGridValuesAndTimes) {
  const RankFolder folder;
  const Mesh mesh = box();
  const Fields fields = fields_on(mesh);
  CgnsWriter writer(mesh, (folder.path / "gas").string());
  const std::array<double, 3> times{0.0, 0.125, 0.5};
  for (std::size_t n = 0; n < times.size(); ++n) {
    const std::string name =
        writer.write(times[n], {{"Velocity", &fields.velocity}}, {{"Share", &fields.share}});
    EXPECT_EQ(name, (folder.path / ("gas_00000" + std::to_string(n) + ".cgns")).string());
    if (rank_here() != 0)
      continue;
    int file = 0, zones = 0;
    ASSERT_EQ(cg_open(name.c_str(), CG_MODE_READ, &file), CG_OK);
    EXPECT_EQ(time_of(file), times[n]);
    ASSERT_EQ(cg_nzones(file, 1, &zones), CG_OK);
    ASSERT_EQ(zones, 4);
    double lowest = 1e300, highest = -1e300;
    for (int z = 1; z <= zones; ++z) {
      const Zone zone = read_zone(file, z);
      EXPECT_EQ(zone.cells, (Index3{3, 4, 2}));
      check_zone(zone);
      lowest = std::min(lowest, zone.node[0].front());
      highest = std::max(highest, zone.node[0].back());
    }
    EXPECT_EQ(lowest, -0.5);
    EXPECT_EQ(highest, 0.5);
    EXPECT_EQ(cg_close(file), CG_OK);
  }
  EXPECT_EQ(writer.next(), 3);
  if (rank_here() == 0) { // nothing unfinished is left
    EXPECT_EQ(std::distance(std::filesystem::directory_iterator(folder.path), {}), 3);
  }
}

TEST(CgnsWriter, GoesOnCountingAfterARestart) {
  const RankFolder folder;
  const Mesh mesh = box();
  const Fields fields = fields_on(mesh);
  CgnsWriter writer(mesh, (folder.path / "gas").string(), 41);
  EXPECT_EQ(writer.write(1.0, {{"Velocity", &fields.velocity}}, {}),
            (folder.path / "gas_000041.cgns").string());
}

TEST(CgnsWriter, AMissingFolderIsAnErrorOnAllRanksBeforeTheFirstStep) {
  const Mesh mesh = box();
  EXPECT_EQ(config_error([&] { CgnsWriter(mesh, "no/such/folder/gas"); }),
            "[output] fields = \"no/such/folder/gas\": the folder \"no/such/folder\" does not "
            "exist");
}

TEST(CgnsWriter, ANameTooLongForTheFormatIsRefused) {
  const RankFolder folder;
  const Mesh mesh = box();
  const Fields fields = fields_on(mesh);
  CgnsWriter writer(mesh, (folder.path / "gas").string());
  const auto message = config_error([&] {
    (void)writer.write(0, {{"VelocityOfTheGasBetweenTheParticles", &fields.velocity}}, {});
  });
  EXPECT_NE(message.find("1 to 32 characters"), std::string::npos) << message;
}

TEST(CgnsWriter, AFolderThatVanishesDuringTheRunIsAnErrorOnAllRanks) {
  const RankFolder folder;
  const Mesh mesh = box();
  const Fields fields = fields_on(mesh);
  const auto inner = folder.path / "inner";
  if (rank_here() == 0)
    std::filesystem::create_directory(inner);
  MPI_Barrier(MPI_COMM_WORLD);
  CgnsWriter writer(mesh, (inner / "gas").string());
  MPI_Barrier(MPI_COMM_WORLD);
  if (rank_here() == 0)
    std::filesystem::remove(inner);
  EXPECT_THROW((void)writer.write(0, {{"Velocity", &fields.velocity}}, {}), NumericalError);
  EXPECT_EQ(writer.next(), 0);
}

TEST(CgnsWriter, AFileThatCannotGrowIsAnErrorOnAllRanks) {
  const RankFolder folder;
  const Mesh mesh = box();
  const Fields fields = fields_on(mesh);
  CgnsWriter writer(mesh, (folder.path / "gas").string());
  // As on a full disk, writes beyond the limit fail.
  const auto handler = std::signal(SIGXFSZ, SIG_IGN);
  rlimit before{};
  getrlimit(RLIMIT_FSIZE, &before);
  rlimit small = before;
  small.rlim_cur = 4096;
  if (rank_here() == 0)
    setrlimit(RLIMIT_FSIZE, &small);
  EXPECT_THROW((void)writer.write(0, {{"Velocity", &fields.velocity}}, {{"Share", &fields.share}}),
               NumericalError);
  setrlimit(RLIMIT_FSIZE, &before);
  std::signal(SIGXFSZ, handler);
  MPI_Barrier(MPI_COMM_WORLD);
  if (rank_here() == 0) {
    EXPECT_TRUE(std::filesystem::is_empty(folder.path));
  }
  // Once there is room again, so is the file.
  MPI_Barrier(MPI_COMM_WORLD);
  EXPECT_NO_THROW((void)writer.write(0, {{"Velocity", &fields.velocity}}, {}));
}
