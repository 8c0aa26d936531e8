// SPDX-FileCopyrightText: 2026 The GranFlux developers
// SPDX-License-Identifier: BSD-3-Clause

// Records of state and the files that hold them: every damage is noticed.
#include <filesystem>
#include <fstream>
#include <limits>
#include <sstream>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include <granflux/cfd/checksum.hpp>
#include <granflux/cfd/error.hpp>
#include <granflux/cfd/state_record.hpp>
#include <granflux/cfd/whole_file.hpp>

using namespace granflux;
using namespace granflux::cfd;

namespace {

std::string record(const std::vector<double>& numbers, bool* finite = nullptr) {
  std::string bytes;
  RecordWriter out("test", numbers.size(), [&](const void* from, std::size_t count) {
    bytes.append(static_cast<const char*>(from), count);
  });
  out.write(numbers);
  out.finish();
  if (finite)
    *finite = out.finite();
  return bytes;
}

std::string refusal(const std::string& bytes, const std::string& kind = "test") {
  try {
    const RecordReader in(kind, bytes);
  } catch (const ConfigError& error) {
    return error.what();
  }
  return "";
}

TEST(Checksum, IsThatOfTheStandard) { // catalogue of CRC algorithms, CRC-64/XZ
  const std::string text = "123456789";
  for (std::size_t cut = 0; cut <= text.size(); ++cut) {
    Checksum sum;
    sum.add(text.data(), cut);
    sum.add(text.data() + cut, text.size() - cut);
    EXPECT_EQ(sum.value(), 0x995DC9BBDF1939FAu);
  }
}

TEST(StateRecord, GivesBackWhatWasWritten) {
  const std::vector<double> numbers{1, -0.5, 3e300};
  const std::string bytes = record(numbers);
  EXPECT_EQ(bytes.size(), RecordWriter::bytes(3));
  EXPECT_EQ(RecordReader::bytes(bytes), bytes.size());
  RecordReader in("test", bytes);
  std::vector<double> read(3);
  in.read(read);
  EXPECT_EQ(read, numbers);
  EXPECT_THROW(in.read(), ConfigError);
}

TEST(StateRecord, EveryFlippedBitAndEveryCutIsNoticed) {
  const std::string whole = record({1, 2, 3, 4});
  ASSERT_EQ(refusal(whole), "");
  for (std::size_t byte = 0; byte < whole.size(); ++byte) {
    for (int bit = 0; bit < 8; ++bit) {
      std::string damaged = whole;
      damaged[byte] = char(damaged[byte] ^ (1 << bit));
      EXPECT_NE(refusal(damaged), "") << byte << ' ' << bit;
    }
    EXPECT_NE(refusal(whole.substr(0, byte)), "") << byte;
  }
  EXPECT_NE(refusal(whole, "other").find("not of \"other\""), std::string::npos);
}

TEST(StateRecord, TellsOfNumbersThatAreNotFinite) {
  for (const double bad :
       {std::numeric_limits<double>::quiet_NaN(), -std::numeric_limits<double>::infinity()}) {
    bool finite = true;
    record({1, bad, 2}, &finite);
    EXPECT_FALSE(finite);
  }
}

std::string content(const std::string& path) {
  std::ostringstream out;
  out << std::ifstream(path).rdbuf();
  return out.str();
}

TEST(WholeFile, AppearsOnlyWhenItIsComplete) {
  const std::string path = "whole_file.test";
  std::ofstream(path) << "before";
  {
    WholeFile file(path);
    file.write("after", 5);
    EXPECT_EQ(content(path), "before");
  }
  EXPECT_EQ(content(path), "before");
  EXPECT_FALSE(std::filesystem::exists(path + ".part"));
  WholeFile file(path);
  file.write("after", 5);
  EXPECT_TRUE(file.finish());
  EXPECT_EQ(content(path), "after");
  EXPECT_FALSE(std::filesystem::exists(path + ".part"));
}

TEST(WholeFile, NamesFileAndCause) {
  WholeFile nowhere("no_such_folder/file");
  nowhere.write("x", 1);
  EXPECT_FALSE(nowhere.finish());
  EXPECT_EQ(nowhere.failure(), "no_such_folder/file: No such file or directory");
}

} // namespace
