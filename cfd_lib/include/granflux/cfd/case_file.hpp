// SPDX-FileCopyrightText: 2026 The GranFlux developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstddef>
#include <initializer_list>
#include <limits>
#include <memory>
#include <mpi.h>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <granflux/cfd/vec3.hpp>

namespace granflux::cfd {

/// What a number of the case file may be. Infinity and not-a-number never are.
struct NumberRange {
  double low = -std::numeric_limits<double>::infinity();
  double high = std::numeric_limits<double>::infinity();
  bool low_included = true, high_included = true;
  [[nodiscard]] bool contains(double value) const {
    return (low_included ? value >= low : value > low) &&
           (high_included ? value <= high : value < high);
  }
};
inline constexpr NumberRange any_number{};
inline constexpr NumberRange positive{.low = 0, .low_included = false};
inline constexpr NumberRange not_negative{.low = 0};
inline constexpr NumberRange zero_to_one{.low = 0, .high = 1};

struct CaseText;

/// One table of a case file. A table that the file lacks reads as an empty one, so that its
/// defaults hold and its required keys are missing. Every key asked for counts as known.
///
/// Errors are ConfigError with file, table, key, value and what is allowed; `unit` goes into
/// their text ("" for pure numbers).
class CaseTable {
public:
  [[nodiscard]] bool has(const std::string& key) const;

  [[nodiscard]] double number(const std::string& key, NumberRange range,
                              std::string_view unit) const;
  [[nodiscard]] double number(const std::string& key, double absent, NumberRange range,
                              std::string_view unit) const;
  [[nodiscard]] int integer(const std::string& key, int low, int high) const;
  [[nodiscard]] int integer(const std::string& key, int absent, int low, int high) const;
  [[nodiscard]] bool flag(const std::string& key, bool absent) const;
  [[nodiscard]] std::string text(const std::string& key) const; ///< not empty
  [[nodiscard]] std::string text(const std::string& key, const std::string& absent) const;

  /// Arrays of three along x, y, z.
  [[nodiscard]] Vec3 vector(const std::string& key, NumberRange range, std::string_view unit) const;
  [[nodiscard]] Vec3 vector(const std::string& key, Vec3 absent, NumberRange range,
                            std::string_view unit) const;
  [[nodiscard]] std::array<int, 3> integers(const std::string& key, int low, int high) const;
  [[nodiscard]] std::array<bool, 3> flags(const std::string& key, std::array<bool, 3> absent) const;
  /// Array of at least `least` numbers.
  [[nodiscard]] std::vector<double> numbers(const std::string& key, std::size_t least,
                                            NumberRange range, std::string_view unit) const;

  /// One word of a list.
  [[nodiscard]] std::string word(const std::string& key,
                                 const std::vector<std::string>& allowed) const;
  [[nodiscard]] std::string word(const std::string& key, const std::string& absent,
                                 const std::vector<std::string>& allowed) const;
  /// The value that goes with the word.
  template <class Value>
  [[nodiscard]] Value
  choice(const std::string& key,
         std::initializer_list<std::pair<std::string_view, Value>> choices) const {
    std::vector<std::string> allowed;
    for (const auto& [name, value] : choices)
      allowed.emplace_back(name);
    const std::string found = word(key, allowed);
    for (const auto& [name, value] : choices)
      if (name == found)
        return value;
    return choices.begin()->second; // not reached: word() returns one of the allowed
  }
  template <class Value>
  [[nodiscard]] Value
  choice(const std::string& key, Value absent,
         std::initializer_list<std::pair<std::string_view, Value>> choices) const {
    if (has(key))
      return choice(key, choices);
    return absent;
  }

  /// Throws where the key is given: a key that exists, but not with the rest of this table.
  void refuse(const std::string& key, const std::string& why) const;
  /// Throws for a value that was read but cannot be used.
  [[noreturn]] void fail(const std::string& key, const std::string& must_be) const;

private:
  friend class CaseFile;
  CaseTable(CaseText& text, std::size_t table) : text_(&text), table_(table) {}
  CaseText* text_;
  std::size_t table_;
};

/// A TOML file in which every key has to be understood by someone: readers take their tables from
/// it, and finish() throws on what none of them asked for. Its tables live as long as it does.
class CaseFile {
public:
  /// Rank 0 reads the file and all ranks get its text, so all throw alike. Collective.
  static CaseFile read(const std::string& path, MPI_Comm comm);
  /// From a text in memory; `name` stands for the file in messages.
  static CaseFile parse(const std::string& text, const std::string& name);
  CaseFile(CaseFile&&) noexcept;
  CaseFile& operator=(CaseFile&&) noexcept;
  ~CaseFile();

  [[nodiscard]] bool has(const std::string& table) const;
  /// The table [name].
  [[nodiscard]] CaseTable table(const std::string& name);
  /// The tables [[name]] in the order of the file; none if the file has none.
  [[nodiscard]] std::vector<CaseTable> tables(const std::string& name);
  /// Leaves a table to a reader that is not there.
  void skip(const std::string& table);
  /// Throws ConfigError naming every table and key that was not asked for, with the nearest known
  /// name.
  void finish() const;

  /// Path or name, as it appears in messages.
  [[nodiscard]] const std::string& name() const;

private:
  explicit CaseFile(std::unique_ptr<CaseText> text);
  std::unique_ptr<CaseText> text_;
};

} // namespace granflux::cfd
