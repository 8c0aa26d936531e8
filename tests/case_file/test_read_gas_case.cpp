// SPDX-FileCopyrightText: 2026 The GranFlux developers
// SPDX-License-Identifier: BSD-3-Clause
#include <fstream>
#include <gtest/gtest.h>
#include <sstream>

#include <granflux/cfd/case_mesh.hpp>

#include "expect_config_error.hpp"
#include "gas_case_text.hpp"

using granflux::Vec3;
using namespace granflux::cfd;
using namespace granflux::test;

TEST(ReadGasCase, TakesEveryKey) {
  const GasCase c = gas_case_of(good_case);
  EXPECT_EQ(box_grid(c).nodes[0], uniform_nodes(0.0, 0.044, 8));
  EXPECT_EQ(box_grid(c).nodes[1], uniform_nodes(0.0, 0.010, 2));
  EXPECT_EQ(box_grid(c).nodes[2], uniform_nodes(0.0, 0.120, 12));
  EXPECT_EQ(box_grid(c).periodic, (std::array<bool, 3>{false, true, false}));
  EXPECT_EQ(box_grid(c).blocks, (Index3{1, 1, 2}));

  EXPECT_EQ(c.fluid.density, 1.2);
  EXPECT_EQ(c.fluid.viscosity, 1.8e-5);
  EXPECT_TRUE(c.fluid.gravity_given);
  EXPECT_EQ(c.fluid.gravity, (Vec3{0, 0, -9.81}));
  EXPECT_EQ(c.fluid.driving_pressure_gradient, (Vec3{0, -1.5, 0}));

  ASSERT_TRUE(c.energy);
  EXPECT_EQ(c.energy->heat_capacity, 1000);
  EXPECT_EQ(c.energy->conductivity, 0.03);
  EXPECT_EQ(c.energy->initial_temperature, 310);
  EXPECT_EQ(c.energy->expansion, 3e-3);
  EXPECT_EQ(c.energy->reference_temperature, 300);

  ASSERT_EQ(c.boundaries.size(), 4u);
  ASSERT_EQ(box_grid(c).patches.size(), 4u);
  EXPECT_EQ(box_grid(c).patches[0].name, "bottom");
  EXPECT_EQ(box_grid(c).patches[0].side, (Side{2, false}));
  EXPECT_EQ(box_grid(c).patches[1].side, (Side{2, true}));
  EXPECT_EQ(box_grid(c).patches[2].side, (Side{0, false}));
  EXPECT_EQ(box_grid(c).patches[3].side, (Side{0, true}));
  const BoundaryCondition& inlet = c.boundaries[0];
  EXPECT_EQ(inlet.name, "bottom");
  EXPECT_EQ(inlet.kind, BoundaryKind::inlet);
  EXPECT_EQ(inlet.velocity, (Vec3{0, 0, 0.9}));
  EXPECT_EQ(inlet.profile, BoundaryCondition::Profile::parabolic);
  EXPECT_EQ(inlet.ramp_time, 0.1);
  EXPECT_EQ(inlet.ramp_from, 0.01);
  EXPECT_EQ(c.boundaries[1].kind, BoundaryKind::outlet);
  EXPECT_EQ(inlet.heat, BoundaryCondition::Heat::temperature);
  EXPECT_EQ(inlet.temperature, 320);
  EXPECT_EQ(c.boundaries[1].temperature, 310);
  EXPECT_EQ(c.boundaries[2].heat, BoundaryCondition::Heat::flux);
  EXPECT_EQ(c.boundaries[2].heat_flux, 25);
  EXPECT_EQ(c.boundaries[3].heat, BoundaryCondition::Heat::adiabatic);
  EXPECT_EQ(c.boundaries[1].pressure, 5.0);
  EXPECT_EQ(c.boundaries[2].kind, BoundaryKind::wall);
  EXPECT_EQ(c.boundaries[2].velocity, (Vec3{0, 0, 0.1}));
  EXPECT_EQ(c.boundaries[3].kind, BoundaryKind::slip);

  EXPECT_EQ(c.initial_velocity, (Vec3{0, 0, 0.5}));
  EXPECT_EQ(c.numerics.convection, ConvectionScheme::upwind2);
  EXPECT_EQ(c.numerics.pressure_solver, PressureMethod::multigrid);
  EXPECT_EQ(c.numerics.pressure_tolerance, 1e-8);
  EXPECT_EQ(c.numerics.viscous_tolerance, 1e-9);
  EXPECT_EQ(c.numerics.time_step, 1e-4);
  EXPECT_EQ(c.numerics.end_time, 0.2);
  EXPECT_EQ(c.output.fields, "post/gas");
  EXPECT_EQ(c.output.every, 0.01);
}

TEST(ReadGasCase, LeavesDefaultsWhereKeysAreAbsent) {
  const GasCase c = gas_case_of("[grid]\nsize = [1, 1, 1]\ncells = [4, 4, 4]\n"
                                "periodic = [true, true, true]\n"
                                "[fluid]\ndensity = 1\nviscosity = 1\n");
  const GasCase defaults;
  EXPECT_EQ(box_grid(c).nodes[2].front(), 0.0);
  EXPECT_EQ(box_grid(c).blocks, (Index3{0, 0, 0}));
  EXPECT_FALSE(c.fluid.gravity_given);
  EXPECT_TRUE(c.boundaries.empty());
  EXPECT_FALSE(c.energy);
  EXPECT_EQ(c.numerics.convection, defaults.numerics.convection);
  EXPECT_EQ(c.numerics.pressure_solver, PressureMethod::automatic);
  EXPECT_EQ(c.numerics.pressure_tolerance, defaults.numerics.pressure_tolerance);
  EXPECT_TRUE(c.output.fields.empty());
}

TEST(ReadGasCase, TakesNodesOfAStretchedBox) {
  const GasCase c = gas_case_of(with("origin = [0.0, 0.0, 0.0]\nsize = [0.044, 0.010, 0.120]\n"
                                     "cells = [8, 2, 12]",
                                     "nodes_x = [0, 0.1, 0.3]\nnodes_y = [-1, 1]\n"
                                     "nodes_z = [0.0, 0.5, 0.75, 2.0, 3.0]"));
  EXPECT_EQ(box_grid(c).nodes[0], (std::vector<double>{0, 0.1, 0.3}));
  EXPECT_EQ(box_grid(c).nodes[1], (std::vector<double>{-1, 1}));
  EXPECT_EQ(box_grid(c).nodes[2], (std::vector<double>{0.0, 0.5, 0.75, 2.0, 3.0}));
}

TEST(ReadGasCase, MakesAMesh) {
  const GasCase c = gas_case_of(good_case);
  const Mesh mesh = make_mesh(c, MPI_COMM_WORLD);
  EXPECT_EQ(mesh.blocks.size(), 2u);
  EXPECT_EQ(mesh.boundaries, (std::vector<std::string>{"bottom", "top", "left", "right"}));
}

TEST(ReadGasCase, TakesEveryKeyOfAnAnnulus) {
  const GasCase c = gas_case_of(annulus_case);
  const auto& a = std::get<AnnulusGrid>(c.grid);
  EXPECT_EQ(a.frame.axis, 0);
  EXPECT_EQ(a.frame.origin, (Vec3{0.1, 0.2, 0.3}));
  EXPECT_EQ(a.inner_radius, 0.01);
  EXPECT_EQ(a.outer_radius, 0.02);
  EXPECT_EQ(a.length, 0.03);
  EXPECT_EQ(a.radial, 4);
  EXPECT_EQ(a.tangential, 24);
  EXPECT_EQ(a.axial, 2);
  EXPECT_EQ(a.start_angle, 15);
  EXPECT_EQ(a.sweep, 360);
  EXPECT_EQ(a.growth, 1.1);
  EXPECT_TRUE(a.periodic_axis);
  ASSERT_EQ(a.arcs.size(), 2u);
  EXPECT_EQ(a.arcs[1].name, "below");
  EXPECT_EQ(a.arcs[1].from, -165);
  EXPECT_EQ(a.arcs[1].to, 15);
  EXPECT_EQ(c.boundaries[1].kind, BoundaryKind::slip);
  const Mesh mesh = make_mesh(c, MPI_COMM_WORLD);
  EXPECT_EQ(mesh.boundaries, (std::vector<std::string>{"inner", "above", "below"}));

  const GasCase drawn = gas_case_of(
      replaced(replaced(replaced(annulus_case, "inner_radius = 0.01\nouter_radius = 0.02",
                                 "nodes_radius = [0.01, 0.011, 0.015, 0.02]"),
                        "growth = 1.1\n", ""),
               "cells = [4, 24, 2]\nstart_angle = 15",
               "cells = [3, 4, 2]\nnodes_angle = [-180, -90, -15, 90, 180]"));
  EXPECT_EQ(std::get<AnnulusGrid>(drawn.grid).radii,
            (std::vector<double>{0.01, 0.011, 0.015, 0.02}));
  EXPECT_EQ(std::get<AnnulusGrid>(drawn.grid).angles,
            (std::vector<double>{-180, -90, -15, 90, 180}));

  const GasCase half = gas_case_of(replaced(annulus_case, "growth = 1.1", "sweep = 180"));
  EXPECT_EQ(std::get<AnnulusGrid>(half.grid).sweep, 180);
}

TEST(ReadGasCase, TakesEveryKeyOfACylinder) {
  const GasCase c = gas_case_of(cylinder_case);
  const auto& cylinder = std::get<CylinderGrid>(c.grid);
  EXPECT_EQ(cylinder.frame.axis, 2);
  EXPECT_EQ(cylinder.radius, 0.0762);
  EXPECT_EQ(cylinder.length, 0.0762);
  EXPECT_EQ(cylinder.radial, 5);
  EXPECT_EQ(cylinder.core, 10);
  EXPECT_EQ(cylinder.axial, 15);
  EXPECT_EQ(cylinder.axial_blocks, 5);
  EXPECT_EQ(cylinder.core_radius, 0.6);
  EXPECT_EQ(cylinder.bulge, 0.25);
  EXPECT_EQ(cylinder.growth, 0.95);
  EXPECT_FALSE(cylinder.periodic_axis);
  const Mesh mesh = make_mesh(c, MPI_COMM_WORLD);
  EXPECT_GE(mesh.blocks.size(), 25u);
  EXPECT_EQ(mesh.boundaries, (std::vector<std::string>{"wall", "low", "high"}));
}

TEST(ReadGasCase, ParticlesNeedABox) {
  EXPECT_EQ(box_grid(gas_case_of(good_case)).blocks, (Index3{1, 1, 2}));
  EXPECT_EQ(config_error([] { (void)box_grid(gas_case_of(cylinder_case)); }),
            "[grid] kind: must be \"box\" for a case with particles: they are located on straight "
            "boxes of cells only");
}

TEST(ReadGasCase, TakesEveryKeyOfAGridFile) {
  CaseFile file = CaseFile::parse(cgns_case, "cases/drum.toml");
  const auto grid = std::get<CgnsGrid>(read_gas_case(file).grid);
  EXPECT_EQ(grid.file, "cases/no/such/drum.cgns");
  EXPECT_EQ(grid.base, "Drum");
  EXPECT_EQ(grid.scale, 0.001);
  CaseFile absolute = CaseFile::parse(replaced(cgns_case, "no/such", "/no/such"), "cases/a.toml");
  EXPECT_EQ(std::get<CgnsGrid>(read_gas_case(absolute).grid).file, "/no/such/drum.cgns");
}

TEST(ReadGasCase, PatchesShareASide) {
  const GasCase c = gas_case_of(with("side = \"z_low\"", "side = \"z_low\"\nto = [0.022, 1, 0]") +
                                "[[boundary]]\nname = \"floor\"\nside = \"z_low\"\n"
                                "from = [0.022, -1, 0]\ntype = \"wall\"\n");
  EXPECT_EQ(box_grid(c).patches[0].to, (Vec3{0.022, 1, 0}));
  EXPECT_EQ(box_grid(c).patches[4].from, (Vec3{0.022, -1, 0}));
  EXPECT_NO_THROW((void)make_mesh(c, MPI_COMM_WORLD));
}

TEST(ReadGasCase, TheExampleOfTheManualIsGood) {
  std::ifstream in(GRANFLUX_CASE_FILE_PAGE);
  std::ostringstream page;
  page << in.rdbuf();
  const std::string text = page.str(), fence = "```toml\n";
  const std::size_t begin = text.find(fence) + fence.size(), end = text.find("```", begin);
  ASSERT_NE(text.find(fence), std::string::npos);
  const GasCase c = gas_case_of(text.substr(begin, end - begin));
  EXPECT_EQ(c.boundaries.size(), 8u);
  EXPECT_NO_THROW((void)make_mesh(c, MPI_COMM_WORLD));
}
