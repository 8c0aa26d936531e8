// SPDX-FileCopyrightText: 2026 The GranFlux developers
// SPDX-License-Identifier: GPL-2.0-or-later
#include "checkpoint_record.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <stdexcept>
#include <string_view>

#include <fmt/core.h>

#include <granflux/cfd/error.hpp>
#include <granflux/cfd/state_record.hpp>

namespace granflux::driver {

namespace {

using cfd::RecordReader;
using cfd::RecordWriter;

constexpr char kind[] = "checkpoint";

/// Of the record; the names of the fixes follow.
struct Numbers {
  CheckpointRecord::Forces forces;
  double ranks, next_sort;
  double letters; ///< of the names
};
using Words = std::array<double, sizeof(Numbers) / sizeof(double)>;

/// IDs and styles, each behind a line break: neither holds one.
std::string names_of(std::span<const KeptFix> fixes) {
  std::string text;
  for (const KeptFix& fix : fixes)
    text += '\n' + fix.id + '\n' + fix.style;
  return text;
}

std::vector<KeptFix> fixes_of(std::string_view text) {
  const auto next = [&] {
    text.remove_prefix(1);
    const std::string_view name = text.substr(0, text.find('\n'));
    text.remove_prefix(name.size());
    return std::string(name);
  };
  std::vector<KeptFix> fixes;
  while (!text.empty()) {
    KeptFix& fix = fixes.emplace_back();
    fix.id = next();
    if (text.empty())
      throw ConfigError("the list of fixes in the checkpoint breaks off");
    fix.style = next();
  }
  return fixes;
}

/// As many numbers as have room for the letters.
std::vector<double> packed(const std::string& text) {
  std::vector<double> numbers((text.size() + sizeof(double) - 1) / sizeof(double));
  std::ranges::copy(text, reinterpret_cast<char*>(numbers.data()));
  return numbers;
}

/// Insertions may be over, and what our own fixes keep of particles is theirs to miss.
bool may_be_left_out(const KeptFix& fix) {
  const std::string_view style = fix.style;
  return style.starts_with("insert/") || style.starts_with("particle") || style == "pour" ||
         style == "deposit" || fix.id.starts_with("granflux_");
}

} // namespace

void write_checkpoint_record(const std::optional<CheckpointRecord>& record, std::FILE* file) {
  const std::string names = record ? names_of(record->fixes) : "";
  const std::vector<double> letters = packed(names);
  const std::size_t count = record ? std::tuple_size_v<Words> + letters.size() : 0;
  const int size = int(RecordWriter::bytes(count));
  bool good = std::fwrite(&size, sizeof size, 1, file) == 1;
  RecordWriter out(kind, count, [&](const void* bytes, std::size_t n) {
    good = std::fwrite(bytes, 1, n, file) == n && good;
  });
  if (record) {
    out.write(std::bit_cast<Words>(Numbers{.forces = record->forces,
                                           .ranks = record->ranks,
                                           .next_sort = record->next_sort,
                                           .letters = double(names.size())}));
    out.write(letters);
  }
  out.finish();
  if (!good)
    throw std::runtime_error("the restart file could not be written: is the disk full?");
}

std::optional<CheckpointRecord> read_checkpoint_record(const char* block) {
  const std::size_t heading = sizeof(cfd::RecordHeading);
  const std::uint64_t size = RecordReader::bytes({block, heading});
  RecordReader in(kind, {block, std::max<std::size_t>(size, heading)});
  if (in.left() == 0)
    return {};
  Words words{};
  in.read(words);
  const auto numbers = std::bit_cast<Numbers>(words);
  std::vector<double> letters(in.left());
  in.read(letters);
  const auto most = double(letters.size() * sizeof(double));
  if (!(numbers.letters >= 0 && numbers.letters <= most))
    throw ConfigError("the list of fixes in the checkpoint breaks off");
  const std::string_view names(reinterpret_cast<const char*>(letters.data()),
                               std::size_t(numbers.letters));
  return CheckpointRecord{.forces = numbers.forces,
                          .ranks = numbers.ranks,
                          .next_sort = numbers.next_sort,
                          .fixes = fixes_of(names)};
}

void check_fixes(const CheckpointRecord& record, std::span<const KeptFix> present) {
  for (const KeptFix& kept : record.fixes) {
    const auto same_style = [&](const KeptFix& fix) { return fix.style == kept.style; };
    const auto same = [&](const KeptFix& fix) { return fix.id == kept.id && same_style(fix); };
    if (std::ranges::any_of(present, same) || may_be_left_out(kept))
      continue;
    // One of that style that the checkpoint does not know has taken the place.
    const auto known = [&](const KeptFix& fix) {
      return std::ranges::any_of(record.fixes, [&](const KeptFix& other) {
        return other.id == fix.id && other.style == fix.style;
      });
    };
    const auto renamed = std::ranges::find_if(
        present, [&](const KeptFix& fix) { return same_style(fix) && !known(fix); });
    throw ConfigError(fmt::format(
        "the checkpoint holds the state of fix {} (style {}), which the script does not have{}: it "
        "would begin anew",
        kept.id, kept.style,
        renamed == present.end()
            ? ""
            : fmt::format("; is it fix {}? The ID must be the same", renamed->id)));
  }
}

} // namespace granflux::driver
