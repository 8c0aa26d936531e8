// SPDX-FileCopyrightText: 2026 The GranFlux developers
// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>
#include <ostream>
#include <vector>

#include <granflux/cfd/case_mesh.hpp>

#include "expect_config_error.hpp"
#include "gas_case_text.hpp"

using namespace granflux::cfd;
using namespace granflux::test;

namespace {

/// One mistake in the good case, and the message it must give.
struct Mistake {
  std::string right, wrong, message;
};
void PrintTo(const Mistake& mistake, std::ostream* out) {
  *out << mistake.wrong;
}

const std::vector<Mistake> mistakes{
    {"kind = \"box\"", "kind = \"sphere\"",
     "bed.toml: [grid] kind = \"sphere\": must be one of \"box\", \"annulus\", \"cylinder\", "
     "\"cgns\""},
    {"size = [0.044, 0.010, 0.120]\n", "",
     "bed.toml: [grid] size is missing: must be three numbers > 0 (m), as [x, y, z]"},
    {"size = [0.044, 0.010, 0.120]", "size = [0.044, 0.0, 0.120]",
     "bed.toml: [grid] size = [0.044, 0, 0.12]: must be three numbers > 0 (m), as [x, y, z]"},
    {"cells = [8, 2, 12]", "cells = [8, 2.5, 12]",
     "bed.toml: [grid] cells = [8, 2.5, 12]: must be three integers from 1 to 1000000, as "
     "[x, y, z]"},
    {"cells = [8, 2, 12]", "cells = [100000, 100000, 1]",
     "bed.toml: [grid] cells = [100000, 100000, 1]: must be at most 2147483647 cells in all"},
    {"kind = \"box\"", "kind = \"box\"\nnodes_x = [0, 1]",
     "bed.toml: [grid] origin = [0, 0, 0]: not allowed: nodes_x, nodes_y and nodes_z take "
     "its place"},
    {"origin = [0.0, 0.0, 0.0]\nsize = [0.044, 0.010, 0.120]\ncells = [8, 2, 12]",
     "nodes_x = [0, 0.2, 0.1]\nnodes_y = [0, 1]\nnodes_z = [0, 1]",
     "bed.toml: [grid] nodes_x = [0, 0.2, 0.1]: must be node coordinates that increase from "
     "each to the next (m)"},
    {"origin = [0.0, 0.0, 0.0]\nsize = [0.044, 0.010, 0.120]\ncells = [8, 2, 12]",
     "nodes_x = [0, 0.2]",
     "bed.toml: [grid] nodes_y is missing: must be an array of 2 or more numbers (m)"},
    {"periodic = [false, true, false]", "periodic = true",
     "bed.toml: [grid] periodic = true: must be three of true or false, as [x, y, z]"},
    {"blocks = [1, 1, 2]", "blocks = [1, 0, 2]",
     "bed.toml: [grid] blocks = [1, 0, 2]: must be three integers from 1 to 1000000, as "
     "[x, y, z]"},
    {"density = 1.2", "density = -1.2",
     "bed.toml: [fluid] density = -1.2: must be a number > 0 (kg/m3)"},
    {"density = 1.2", "density = nan",
     "bed.toml: [fluid] density = nan: must be a number > 0 (kg/m3)"},
    {"density = 1.2", "density = \"air\"",
     "bed.toml: [fluid] density = \"air\": must be a number > 0 (kg/m3)"},
    {"heat_capacity = 1000.0", "heat_capacity = 0",
     "bed.toml: [energy] heat_capacity = 0: must be a number > 0 (J/(kg K))"},
    {"expansion = 3e-3\n", "",
     "bed.toml: [energy] reference_temperature = 300: not allowed: it needs an expansion > 0"},
    {"heat_flux = 25.0", "heat_flux = 25.0\ntemperature = 300",
     "bed.toml: [[boundary]] 3 \"left\" temperature = 300: not allowed: a wall has a temperature "
     "or "
     "a "
     "heat_flux"},
    {"pressure = 5.0", "pressure = 5.0\nheat_flux = 1",
     "bed.toml: [[boundary]] 2 \"top\" heat_flux = 1: not allowed: only a wall has a heat flux"},
    {"temperature = 320.0\n", "",
     "bed.toml: [[boundary]] 1 \"bottom\" temperature is missing: must be a number > 0 (K)"},
    {"density = 1.2\n", "", "bed.toml: [fluid] density is missing: must be a number > 0 (kg/m3)"},
    {"density = 1.2", "densty = 1.2",
     "bed.toml: [fluid] density is missing: must be a number > 0 (kg/m3); densty (line 10) is "
     "unknown: did you mean density?"},
    {"[fluid]", "[fluids]",
     "bed.toml: [fluid] density is missing: must be a number > 0 (kg/m3); fluids (line 9) is "
     "unknown: did you mean fluid?"},
    {"origin = [0.0, 0.0, 0.0]\nsize = [0.044, 0.010, 0.120]\ncells = [8, 2, 12]",
     "nodes_x = [0, 0.2]\nnodes_z = [0, 0.2]",
     "bed.toml: [grid] nodes_y is missing: must be an array of 2 or more numbers (m)"},
    {"density = 1.2", "density = 1.2\ndensiti = 1",
     "bed.toml: [fluid] densiti (line 11): unknown key; did you mean density?"},
    {"viscosity = 1.8e-5", "viscosity = 0",
     "bed.toml: [fluid] viscosity = 0: must be a number > 0 (Pa s)"},
    {"gravity = [0.0, 0.0, -9.81]", "gravity = [0.0, 0.0, inf]",
     "bed.toml: [fluid] gravity = [0, 0, inf]: must be three numbers (m/s2), as [x, y, z]"},
    {"driving_pressure_gradient = [0.0, -1.5, 0.0]", "driving_pressure_gradient = [0.0, 0.0, -1.5]",
     "bed.toml: [fluid] driving_pressure_gradient = [0, 0, -1.5]: must be 0 along z, which "
     "is not periodic: there, boundaries drive the flow (Pa/m)"},
    {"name = \"top\"\n", "", "bed.toml: [[boundary]] 2 name is missing: must be a text in quotes"},
    {"name = \"top\"", "name = \"bottom\"",
     "bed.toml: [[boundary]] 2 \"bottom\" name = \"bottom\": must be a name of its own: another "
     "[[boundary]] has this one"},
    {"side = \"z_low\"", "side = \"y_low\"",
     "bed.toml: [[boundary]] 1 \"bottom\" side = \"y_low\": must be a side that [grid] periodic "
     "does "
     "not connect to the opposite one"},
    {"side = \"z_low\"", "side = \"zlow\"",
     "bed.toml: [[boundary]] 1 \"bottom\" side = \"zlow\": must be one of \"x_low\", \"x_high\", "
     "\"y_low\", \"y_high\", \"z_low\", \"z_high\"; did you mean z_low?"},
    {"side = \"z_low\"", "side = \"z_low\"\nfrom = [1, 0, 0]\nto = [0, 1, 0]",
     "bed.toml: [[boundary]] 1 \"bottom\" to = [0, 1, 0]: must be not below `from` along x"},
    {"type = \"outlet\"", "type = \"outlt\"",
     "bed.toml: [[boundary]] 2 \"top\" type = \"outlt\": must be one of \"inlet\", \"outlet\", "
     "\"wall\", \"slip\", \"symmetry\"; did you mean outlet?"},
    {"type = \"outlet\"\npressure = 5.0", "type = \"wall\"",
     "bed.toml: [[boundary]] \"bottom\" is an inlet, but no [[boundary]] has type = \"outlet\": "
     "the gas could not leave"},
    {"pressure = 5.0", "velocity = [0, 0, 1]",
     "bed.toml: [[boundary]] 2 \"top\" velocity = [0, 0, 1]: not allowed: only an inlet or a "
     "wall has a velocity"},
    {"type = \"slip\"", "type = \"slip\"\npressure = 1",
     "bed.toml: [[boundary]] 4 \"right\" pressure = 1: not allowed: only an outlet has a pressure"},
    {"type = \"slip\"", "type = \"slip\"\nramp_time = 1",
     "bed.toml: [[boundary]] 4 \"right\" ramp_time = 1: not allowed: only an inlet has a "
     "ramp_time"},
    {"velocity = [0.0, 0.0, 0.9]", "velocity = [0.0, 0.0, -0.9]",
     "bed.toml: [[boundary]] 1 \"bottom\" velocity = [0, 0, -0.9]: must be directed into the "
     "box: gas leaves through an outlet (m/s)"},
    {"velocity = [0.0, 0.0, 0.9]\n", "",
     "bed.toml: [[boundary]] 1 \"bottom\" velocity is missing: must be three numbers (m/s), as "
     "[x, y, z]"},
    {"profile = \"parabolic\"", "profile = \"plug\"",
     "bed.toml: [[boundary]] 1 \"bottom\" profile = \"plug\": must be one of \"uniform\", "
     "\"parabolic\""},
    {"ramp_time = 0.1\n", "",
     "bed.toml: [[boundary]] 1 \"bottom\" ramp_from = 0.01: not allowed: it needs a ramp_time > "
     "0"},
    {"velocity = [0.0, 0.0, 0.1]", "velocity = [0.1, 0.0, 0.0]",
     "bed.toml: [[boundary]] 3 \"left\" velocity = [0.1, 0, 0]: must be 0 along x: a wall "
     "moves in its own plane only (m/s)"},
    {"convection = \"upwind2\"", "convection = \"upwind\"",
     "bed.toml: [numerics] convection = \"upwind\": must be one of \"central\", \"upwind2\", "
     "\"limited\"; did you mean upwind2?"},
    {"pressure_solver = \"multigrid\"", "pressure_solver = \"multi\"",
     "bed.toml: [numerics] pressure_solver = \"multi\": must be one of \"auto\", \"direct\", "
     "\"multigrid\", \"hypre\""},
    {"pressure_tolerance = 1e-8", "pressure_tolerance = 0.5",
     "bed.toml: [numerics] pressure_tolerance = 0.5: must be a number >= 1e-15 and <= 0.01"},
    {"time_step = 1e-4", "time_step = 0",
     "bed.toml: [numerics] time_step = 0: must be a number > 0 (s)"},
    {"every = 0.01\n", "", "bed.toml: [output] every is missing: must be a number > 0 (s)"},
    {"fields = \"post/gas\"\n", "",
     "bed.toml: [output] every = 0.01: not allowed: it needs fields, the path of the files to "
     "write"},
    {"[initial]", "[initail]",
     "bed.toml: [initail] (line 50): unknown table; did you mean initial?"},
    {"[fluid]", "[fluid", "bed.toml: line 9, column "},
};

class BadGasCase : public testing::TestWithParam<Mistake> {};

} // namespace

TEST_P(BadGasCase, GivesTheMessage) {
  const Mistake& mistake = GetParam();
  const std::string message =
      config_error([&] { (void)gas_case_of(with(mistake.right, mistake.wrong)); });
  if (mistake.message.ends_with("column "))
    EXPECT_TRUE(message.starts_with(mistake.message)) << message;
  else
    EXPECT_EQ(message, mistake.message);
}
INSTANTIATE_TEST_SUITE_P(Mistakes, BadGasCase, testing::ValuesIn(mistakes));

namespace {

/// One mistake in another case, found when it is read or when its mesh is made.
struct RoundMistake {
  std::string text, right, wrong, message;
};
void PrintTo(const RoundMistake& mistake, std::ostream* out) {
  *out << mistake.wrong;
}

const std::vector<RoundMistake> round_mistakes{
    {annulus_case, "inner_radius = 0.01", "inner_radius = 0.02",
     "bed.toml: [grid] outer_radius = 0.02: must be larger than inner_radius (m)"},
    {annulus_case, "axis = \"x\"", "axis = \"radial\"",
     "bed.toml: [grid] axis = \"radial\": must be one of \"x\", \"y\", \"z\""},
    {annulus_case, "cells = [4, 24, 2]", "cells = [4, 3, 2]",
     "bed.toml: [grid] cells = [4, 3, 2]: must be more around: a cell must span less than 120 "
     "degrees"},
    {annulus_case, "growth = 1.1", "sweep = 400",
     "bed.toml: [grid] sweep = 400: must be a number > 0 and <= 360 (degrees)"},
    {annulus_case, "growth = 1.1", "nodes_radius = [0.01, 0.02]",
     "bed.toml: [grid] inner_radius = 0.01: not allowed: nodes_radius takes its place"},
    {annulus_case, "start_angle = 15", "nodes_angle = [0, 90, 180, 270, 360]",
     "bed.toml: [grid] nodes_angle = [0, 90, 180, 270, 360]: must be 25 numbers, one more than "
     "cells"},
    {annulus_case, "start_angle = 15", "nodes_angle = [0, 90, 80]",
     "bed.toml: [grid] nodes_angle = [0, 90, 80]: must be node coordinates that increase from each "
     "to the next (degrees)"},
    {annulus_case, "growth = 1.1", "size = [1, 1, 1]",
     "bed.toml: [grid] size (line 10): unknown key; "},
    {annulus_case, "angles = [15, 195]", "angles = [15, 10]",
     "bed.toml: [[boundary]] 2 \"above\" angles = [15, 10]: must be two numbers, the second larger "
     "by at most 360 (degrees)"},
    {annulus_case, "angles = [15, 195]", "side = \"x_low\"",
     "bed.toml: [[boundary]] 2 \"above\" side = \"x_low\": not allowed: only a box has sides; the "
     "name is that of a boundary of the grid"},
    {annulus_case, "angles = [15, 195]", "angles = [15, 30]",
     "the outer circle has no boundary at 37.5 degrees: its arcs must cover it"},
    {annulus_case, "angles = [15, 195]", "angles = [0, 195]",
     "boundaries \"above\" and \"below\" overlap on the outer circle at 367.5 degrees: each face "
     "takes one boundary"},
    {annulus_case, "name = \"inner\"", "name = \"iner\"",
     "[[boundary]] \"iner\": the grid has no boundary of that name; the grid's boundaries are: "
     "inner, above, below"},
    {annulus_case, "gradient = [-1.0, 0.0, 0.0]", "gradient = [0.0, -1.0, 0.0]",
     "[fluid] driving_pressure_gradient: must be 0 along y, which is not periodic: there, "
     "boundaries drive the flow (Pa/m)"},
    {annulus_case, "periodic_axis = true", "periodic_axis = false",
     "boundary \"low\" of the grid has no [[boundary]]; the grid's boundaries are: inner, above, "
     "below, low, high"},
    {cylinder_case, "cells = [5, 10, 15]", "cells = [5, 1, 15]",
     "bed.toml: [grid] cells = [5, 1, 15]: must be at least 2 across the core"},
    {cylinder_case, "axial_blocks = 5", "axial_blocks = 8",
     "bed.toml: [grid] axial_blocks = 8: must be an integer from 1 to 7"},
    {cylinder_case, "core_radius = 0.6", "core_radius = 1",
     "bed.toml: [grid] core_radius = 1: must be a number > 0 and < 1 (share of the radius)"},
    {cylinder_case, "bulge = 0.25", "bulge = 1",
     "bed.toml: [grid] bulge = 1: must be a number >= 0 and < 1"},
    {cylinder_case, "name = \"wall\"", "name = \"wall\"\nangles = [0, 90]",
     "bed.toml: [[boundary]] 1 \"wall\" angles = [0, 90]: not allowed: only an annulus has arcs"},
    {cylinder_case, "type = \"inlet\"", "type = \"inlet\"\nprofile = \"parabolic\"",
     "bed.toml: [[boundary]] 2 \"low\" profile = \"parabolic\": must be \"uniform\": a parabola "
     "needs "
     "a rectangle on the side of a box"},
    {cgns_case, "scale = 0.001", "scale = 0",
     "bed.toml: [grid] scale = 0: must be a number > 0 (m per unit of the file)"},
    {cgns_case, "file = \"no/such/drum.cgns\"", "",
     "bed.toml: [grid] file is missing: must be a text in quotes"},
    {cgns_case, "name = \"shell\"", "name = \"shell\"\nside = \"x_low\"",
     "bed.toml: [[boundary]] 1 \"shell\" side = \"x_low\": not allowed: only a box has sides; the "
     "name is that of a boundary of the grid"},
    {cgns_case, "scale", "scale",
     "[grid] file = \"no/such/drum.cgns\": cannot be read: No such file or directory"},
};

class BadRoundGrid : public testing::TestWithParam<RoundMistake> {};

} // namespace

TEST_P(BadRoundGrid, GivesTheMessage) {
  const RoundMistake& mistake = GetParam();
  const std::string message = config_error([&] {
    const GasCase c = gas_case_of(replaced(mistake.text, mistake.right, mistake.wrong));
    (void)make_mesh(c, MPI_COMM_WORLD);
  });
  if (mistake.message.ends_with("; "))
    EXPECT_TRUE(message.starts_with(mistake.message)) << message;
  else
    EXPECT_EQ(message, mistake.message);
}
INSTANTIATE_TEST_SUITE_P(Mistakes, BadRoundGrid, testing::ValuesIn(round_mistakes));

TEST(BadPatches, OverlapIsRefusedByTheMesh) {
  const GasCase c = gas_case_of(good_case + "[[boundary]]\nname = \"jet\"\nside = \"z_low\"\n"
                                            "to = [0.011, 1, 0]\ntype = \"wall\"\n");
  const auto message = config_error([&] { (void)make_mesh(c, MPI_COMM_WORLD); });
  EXPECT_NE(message.find("\"bottom\" and \"jet\" overlap"), std::string::npos) << message;
}

TEST(BadPatches, AFaceWithoutABoundaryIsRefusedByTheMesh) {
  const GasCase c = gas_case_of(with("side = \"x_high\"", "side = \"x_high\"\nto = [1, 1, 0.06]"));
  const auto message = config_error([&] { (void)make_mesh(c, MPI_COMM_WORLD); });
  EXPECT_NE(message.find("side x_high: 12 faces have no boundary"), std::string::npos) << message;
}

TEST(BadGasCaseFile, AMissingFileIsAnErrorOnAllRanks) {
  EXPECT_EQ(config_error([] { (void)read_gas_case("no_such.toml", MPI_COMM_WORLD); }),
            "case file \"no_such.toml\" cannot be read: No such file or directory");
}
