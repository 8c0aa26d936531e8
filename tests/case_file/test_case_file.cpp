// SPDX-FileCopyrightText: 2026 The GranFlux developers
// SPDX-License-Identifier: BSD-3-Clause
#include <fstream>
#include <gtest/gtest.h>
#include <mpi.h>

#include <granflux/cfd/case_file.hpp>

#include "expect_config_error.hpp"
#include "rank_folder.hpp"

using granflux::Vec3;
using granflux::test::config_error;
using granflux::test::rank_here;
using granflux::test::RankFolder;
using namespace granflux::cfd;

namespace {

/// Message of a getter on the table [t] with the given lines.
template <class Get> std::string error_of(const std::string& lines, Get get) {
  CaseFile file = CaseFile::parse("[t]\n" + lines, "bed.toml");
  const CaseTable table = file.table("t");
  return config_error([&] { get(table); });
}

} // namespace

TEST(CaseFile, GetsValuesOfEveryKind) {
  CaseFile file = CaseFile::parse(R"(
[t]
a = 1.5
b = 2
c = -3
d = true
e = "text"
f = [1, 2.5, -3]
g = [1, 2, 3]
h = [true, false, true]
i = [0.0, 0.1, 0.2, 0.3]
j = "two"
)",
                                  "bed.toml");
  const CaseTable t = file.table("t");
  EXPECT_EQ(t.number("a", positive, "m"), 1.5);
  EXPECT_EQ(t.number("b", positive, "m"), 2.0);
  EXPECT_EQ(t.integer("c", -5, 5), -3);
  EXPECT_TRUE(t.flag("d", false));
  EXPECT_EQ(t.text("e"), "text");
  EXPECT_EQ(t.vector("f", any_number, "m"), (Vec3{1, 2.5, -3}));
  EXPECT_EQ(t.integers("g", 1, 3), (std::array<int, 3>{1, 2, 3}));
  EXPECT_EQ(t.flags("h", {}), (std::array<bool, 3>{true, false, true}));
  EXPECT_EQ(t.numbers("i", 2, any_number, "m"), (std::vector<double>{0.0, 0.1, 0.2, 0.3}));
  EXPECT_EQ(t.choice<int>("j", {{"one", 1}, {"two", 2}}), 2);
  EXPECT_NO_THROW(file.finish());
}

TEST(CaseFile, GivesDefaultsForAbsentKeysAndTables) {
  CaseFile file = CaseFile::parse("", "bed.toml");
  const CaseTable t = file.table("t");
  EXPECT_EQ(t.number("a", 7.0, positive, "m"), 7.0);
  EXPECT_EQ(t.integer("a", 7, 0, 9), 7);
  EXPECT_TRUE(t.flag("a", true));
  EXPECT_EQ(t.text("a", "x"), "x");
  EXPECT_EQ(t.vector("a", Vec3{1, 2, 3}, any_number, "m"), (Vec3{1, 2, 3}));
  EXPECT_EQ(t.flags("a", {true, true, false}), (std::array<bool, 3>{true, true, false}));
  EXPECT_EQ(t.word("a", "x", {"x", "y"}), "x");
  EXPECT_EQ(t.choice<int>("a", 4, {{"one", 1}}), 4);
  EXPECT_FALSE(file.has("t"));
  EXPECT_TRUE(file.tables("many").empty());
  EXPECT_NO_THROW(file.finish());
}

TEST(CaseFile, TablesComeInOrderAndOutliveAMove) {
  CaseFile first = CaseFile::parse("[[many]]\nn = 1\n[[many]]\nn = 2\n", "bed.toml");
  const auto tables = first.tables("many");
  const CaseFile moved = std::move(first);
  ASSERT_EQ(tables.size(), 2u);
  EXPECT_EQ(tables[0].integer("n", 0, 9), 1);
  EXPECT_EQ(tables[1].integer("n", 0, 9), 2);
  EXPECT_NO_THROW(moved.finish());
}

TEST(CaseFileError, NamesFileTableKeyValueAndWhatIsAllowed) {
  EXPECT_EQ(error_of("a = -1.2", [](auto& t) { (void)t.number("a", positive, "kg/m3"); }),
            "bed.toml: [t] a = -1.2: must be a number > 0 (kg/m3)");
  EXPECT_EQ(error_of("a = 3", [](auto& t) { (void)t.number("a", zero_to_one, ""); }),
            "bed.toml: [t] a = 3: must be a number >= 0 and <= 1");
  EXPECT_EQ(error_of("a = -1", [](auto& t) { (void)t.number("a", 0.0, not_negative, "s"); }),
            "bed.toml: [t] a = -1: must be a number >= 0 (s)");
  EXPECT_EQ(error_of("a = 0", [](auto& t) { (void)t.integer("a", 1, 9); }),
            "bed.toml: [t] a = 0: must be an integer from 1 to 9");
  EXPECT_EQ(error_of("a = [1, 2]", [](auto& t) { (void)t.vector("a", positive, "m"); }),
            "bed.toml: [t] a = [1, 2]: must be three numbers > 0 (m), as [x, y, z]");
  EXPECT_EQ(error_of("a = [1, 2, 0]", [](auto& t) { (void)t.integers("a", 1, 5); }),
            "bed.toml: [t] a = [1, 2, 0]: must be three integers from 1 to 5, as [x, y, z]");
  EXPECT_EQ(error_of("a = [1.0]", [](auto& t) { (void)t.numbers("a", 2, any_number, "m"); }),
            "bed.toml: [t] a = [1]: must be an array of 2 or more numbers (m)");
}

TEST(CaseFileError, RefusesTheWrongType) {
  EXPECT_EQ(error_of("a = \"1.2\"", [](auto& t) { (void)t.number("a", any_number, "m"); }),
            "bed.toml: [t] a = \"1.2\": must be a number (m)");
  EXPECT_EQ(error_of("a = 1.5", [](auto& t) { (void)t.integer("a", 0, 9); }),
            "bed.toml: [t] a = 1.5: must be an integer from 0 to 9");
  EXPECT_EQ(error_of("a = 1", [](auto& t) { (void)t.flag("a", true); }),
            "bed.toml: [t] a = 1: must be true or false");
  EXPECT_EQ(error_of("a = 1", [](auto& t) { (void)t.text("a"); }),
            "bed.toml: [t] a = 1: must be a text in quotes");
  EXPECT_EQ(error_of("a = \"\"", [](auto& t) { (void)t.text("a"); }),
            "bed.toml: [t] a = \"\": must be a text in quotes");
  EXPECT_EQ(error_of("a = [true, 1, false]", [](auto& t) { (void)t.flags("a", {}); }),
            "bed.toml: [t] a = [true, 1, false]: must be three of true or false, as [x, y, z]");
  EXPECT_EQ(error_of("[t.a]\nb = 1", [](auto& t) { (void)t.number("a", any_number, "m"); }),
            "bed.toml: [t] a = a table: must be a number (m)");
}

TEST(CaseFileError, RefusesInfinityAndNotANumber) {
  for (const std::string value : {"nan", "+nan", "-nan", "inf", "-inf"}) {
    const auto number =
        error_of("a = " + value, [](auto& t) { (void)t.number("a", any_number, ""); });
    EXPECT_TRUE(number.ends_with(": must be a number")) << number;
    const auto vector = error_of("a = [0, " + value + ", 0]",
                                 [](auto& t) { (void)t.vector("a", any_number, "m"); });
    EXPECT_TRUE(vector.ends_with(": must be three numbers (m), as [x, y, z]")) << vector;
    const auto numbers = error_of("a = [0, " + value + "]",
                                  [](auto& t) { (void)t.numbers("a", 1, any_number, "m"); });
    EXPECT_TRUE(numbers.ends_with(": must be an array of 1 or more numbers (m)")) << numbers;
  }
}

TEST(CaseFileError, SaysThatAKeyIsMissing) {
  EXPECT_EQ(error_of("", [](auto& t) { (void)t.number("a", positive, "m"); }),
            "bed.toml: [t] a is missing: must be a number > 0 (m)");
}

TEST(CaseFileError, OffersTheNearestWord) {
  const auto get = [](auto& t) { (void)t.word("a", {"inlet", "outlet"}); };
  EXPECT_EQ(
      error_of("a = \"inlt\"", get),
      "bed.toml: [t] a = \"inlt\": must be one of \"inlet\", \"outlet\"; did you mean inlet?");
  EXPECT_EQ(error_of("a = \"door\"", get),
            "bed.toml: [t] a = \"door\": must be one of \"inlet\", \"outlet\"");
  EXPECT_EQ(error_of("a = 3", get), "bed.toml: [t] a = 3: must be one of \"inlet\", \"outlet\"");
}

TEST(CaseFileError, RefusesAKeyThatDoesNotBelong) {
  EXPECT_EQ(error_of("a = 3", [](auto& t) { t.refuse("a", "only an inlet has it"); }),
            "bed.toml: [t] a = 3: not allowed: only an inlet has it");
}

TEST(CaseFileError, CutsLongValues) {
  std::string lines = "a = [";
  for (int i = 0; i < 1000; ++i)
    lines += "1, ";
  const auto text = error_of(lines + "]", [](auto& t) { (void)t.vector("a", any_number, "m"); });
  EXPECT_EQ(text, "bed.toml: [t] a = [1, 1, 1, 1, 1, 1, ...]: must be three numbers (m), as "
                  "[x, y, z]");
}

TEST(CaseFileError, FinishNamesEveryKeyThatNobodyAskedFor) {
  CaseFile file = CaseFile::parse("[fluid]\ndensty = 1\nviscosity = 1\n\n[fluids]\na = 1\n"
                                  "[[boundary]]\nname = \"top\"\ncolour = 1\n",
                                  "bed.toml");
  const CaseTable fluid = file.table("fluid");
  (void)fluid.number("density", 1.0, positive, "kg/m3");
  (void)fluid.number("viscosity", positive, "Pa s");
  for (const CaseTable& boundary : file.tables("boundary"))
    (void)boundary.text("name");
  EXPECT_EQ(config_error([&] { file.finish(); }),
            "bed.toml: [fluids] (line 5): unknown table; did you mean fluid?\n"
            "bed.toml: [fluid] densty (line 2): unknown key; did you mean density?\n"
            "bed.toml: [[boundary]] 1 \"top\" colour (line 9): unknown key; known are: name");
}

TEST(CaseFileError, FinishLeavesSkippedTablesAlone) {
  CaseFile file = CaseFile::parse("[coupling]\ndrag = \"any\"\n", "bed.toml");
  file.skip("coupling");
  EXPECT_NO_THROW(file.finish());
}

TEST(CaseFileError, TableOfTheWrongKind) {
  CaseFile file = CaseFile::parse("grid = 3\nboundary = []\n[[fluid]]\na = 1\n", "bed.toml");
  EXPECT_EQ(config_error([&] { (void)file.table("grid"); }),
            "bed.toml: grid = 3: must be a table [grid]");
  EXPECT_EQ(config_error([&] { (void)file.table("fluid"); }),
            "bed.toml: fluid = tables: must be a table [fluid]");
  EXPECT_EQ(config_error([&] { (void)file.tables("grid"); }),
            "bed.toml: grid = 3: must be tables [[grid]]");
}

TEST(CaseFileError, SyntaxErrorHasLineAndColumn) {
  const auto text =
      config_error([] { (void)CaseFile::parse("[t]\na = 1\nb = = 2\n", "bed.toml"); });
  EXPECT_TRUE(text.starts_with("bed.toml: line 3, column 5: ")) << text;
  const auto twice = config_error([] { (void)CaseFile::parse("a = 1\na = 2\n", "bed.toml"); });
  EXPECT_TRUE(twice.starts_with("bed.toml: line 2, column ")) << twice;
  const auto binary =
      config_error([] { (void)CaseFile::parse(std::string("a = \"\xff\xfe\0\"", 9), "bed.toml"); });
  EXPECT_TRUE(binary.starts_with("bed.toml: line 1, column ")) << binary;
}

TEST(CaseFileRead, AllRanksGetTheTextThatRankZeroReads) {
  const RankFolder folder;
  const auto path = folder.path / "case.toml";
  if (rank_here() == 0)
    std::ofstream(path) << "[t]\na = 1.25\n";
  CaseFile file = CaseFile::read(path.string(), MPI_COMM_WORLD);
  EXPECT_EQ(file.table("t").number("a", positive, ""), 1.25);
  EXPECT_EQ(file.name(), path.string());
}

TEST(CaseFileRead, OnlyRankZeroNeedsToSeeTheFile) {
  const std::string path = rank_here() == 0 ? "/no/such/folder/bed.toml" : "/dev/null";
  const auto text = config_error([&] { (void)CaseFile::read(path, MPI_COMM_WORLD); });
  EXPECT_TRUE(text.ends_with("cannot be read: No such file or directory")) << text;
}

TEST(CaseFileRead, MissingFileAndFolderAreErrorsOnAllRanks) {
  EXPECT_EQ(config_error([] { (void)CaseFile::read("no_such.toml", MPI_COMM_WORLD); }),
            "case file \"no_such.toml\" cannot be read: No such file or directory");
  EXPECT_EQ(config_error([] { (void)CaseFile::read("/tmp", MPI_COMM_WORLD); }),
            "case file \"/tmp\" cannot be read: Is a directory");
}

TEST(CaseFileRead, EmptyFileReadsAsNoTables) {
  CaseFile file = CaseFile::read("/dev/null", MPI_COMM_WORLD);
  EXPECT_NO_THROW(file.finish());
}
