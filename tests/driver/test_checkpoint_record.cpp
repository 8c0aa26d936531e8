// SPDX-FileCopyrightText: 2026 The GranFlux developers
// SPDX-License-Identifier: BSD-3-Clause
#include <array>
#include <cstdio>
#include <memory>
#include <vector>

#include <gtest/gtest.h>

#include <granflux/cfd/error.hpp>

#include "driver/checkpoint_record.hpp"

namespace granflux::driver {
namespace {

const CheckpointRecord bed{.forces = {.time_step = 1e-5, .with_gas = 1},
                           .ranks = 2,
                           .next_sort = 3000,
                           .fixes = {{"gas", "granflux/couple"},
                                     {"heat", "granflux/heat"},
                                     {"floor", "wall/gran"},
                                     {"fill", "insert/pack"},
                                     {"granflux_fluid", "property/atom"}}};

/// The block behind its length, as hosts hand it back.
std::vector<char> block_of(const std::optional<CheckpointRecord>& record) {
  const std::unique_ptr<std::FILE, int (*)(std::FILE*)> file(std::tmpfile(), std::fclose);
  write_checkpoint_record(record, file.get());
  std::rewind(file.get());
  int size = 0;
  EXPECT_EQ(std::fread(&size, sizeof size, 1, file.get()), 1u);
  std::vector<char> block(std::size_t(size) + 1);
  EXPECT_EQ(std::fread(block.data(), 1, block.size(), file.get()), std::size_t(size));
  block.pop_back();
  return block;
}

TEST(CheckpointRecord, ComesBackAsItWas) {
  const auto back = read_checkpoint_record(block_of(bed).data());
  ASSERT_TRUE(back);
  EXPECT_EQ(back->forces, bed.forces);
  EXPECT_EQ(back->ranks, 2);
  EXPECT_EQ(back->next_sort, 3000);
  ASSERT_EQ(back->fixes.size(), bed.fixes.size());
  for (std::size_t i = 0; i < bed.fixes.size(); ++i) {
    EXPECT_EQ(back->fixes[i].id, bed.fixes[i].id);
    EXPECT_EQ(back->fixes[i].style, bed.fixes[i].style);
  }
}

TEST(CheckpointRecord, OfAnOrdinaryRestartFileIsEmpty) {
  EXPECT_FALSE(read_checkpoint_record(block_of({}).data()));
}

TEST(CheckpointRecord, EveryDamagedByteIsFound) {
  const std::vector<char> whole = block_of(bed);
  for (std::size_t place = 0; place < whole.size(); ++place) {
    std::vector<char> damaged = whole;
    damaged[place] = char(damaged[place] ^ 4);
    EXPECT_THROW((void)read_checkpoint_record(damaged.data()), ConfigError) << place;
  }
}

std::string complaint(const std::vector<KeptFix>& present) {
  try {
    check_fixes(bed, present);
  } catch (const ConfigError& e) {
    return e.what();
  }
  return {};
}

TEST(CheckpointRecord, FixesMustBeThoseOfTheCheckpoint) {
  const KeptFix gas{"gas", "granflux/couple"}, heat{"heat", "granflux/heat"},
      floor{"floor", "wall/gran"};
  EXPECT_EQ(complaint({gas, heat, floor}), ""); // insertion is over
  EXPECT_EQ(complaint({floor, {"more", "wall/gran"}, heat, gas}), "");
  EXPECT_EQ(complaint({{"air", "granflux/couple"}, heat, floor}),
            "the checkpoint holds the state of fix gas (style granflux/couple), which the script "
            "does not have; is it fix air? The ID must be the same: it would begin anew");
  EXPECT_EQ(complaint({gas, floor}),
            "the checkpoint holds the state of fix heat (style granflux/heat), which the script "
            "does not have: it would begin anew");
  EXPECT_NE(complaint({gas, heat, {"floor", "wall/region"}}), "");
}

} // namespace
} // namespace granflux::driver
