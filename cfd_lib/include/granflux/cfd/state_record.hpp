// SPDX-FileCopyrightText: 2026 The GranFlux developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <string_view>

#include <granflux/cfd/checksum.hpp>

namespace granflux::cfd {

inline constexpr std::string_view record_magic = "granflux record";

/// A record is what is kept of a run: numbers behind a heading (what it is, format, how many
/// numbers, checksum of the heading) and before a checksum of them all. Torn, damaged and foreign
/// ones are told apart. Words of 8 bytes in the order of this machine.
struct RecordHeading {
  std::array<char, 16> magic{}, kind{};
  std::uint64_t format = 0; ///< also tells the order of bytes
  std::uint64_t count = 0;  ///< numbers
  std::uint64_t checksum = 0;
};

/// For one rank.
class RecordWriter {
public:
  using Sink = std::function<void(const void* bytes, std::size_t count)>;

  /// `kind`: at most 15 letters. `count`: how many numbers will be written.
  RecordWriter(std::string_view kind, std::uint64_t count, Sink sink);

  void write(std::span<const double> numbers);
  void write(double number) { write({&number, 1}); }
  /// After the last number.
  void finish();

  /// Of a record with so many numbers.
  static std::uint64_t bytes(std::uint64_t count) { return sizeof(RecordHeading) + 8 * count + 8; }
  /// No number so far was infinite or not a number.
  [[nodiscard]] bool finite() const { return finite_; }

private:
  Sink sink_;
  Checksum sum_;
  std::uint64_t left_;
  bool finite_ = true;
};

/// For one rank.
class RecordReader {
public:
  /// Reads all of it once. Throws ConfigError where `bytes` do not begin with a whole record of
  /// that kind.
  RecordReader(std::string_view kind, std::span<const char> bytes);

  /// The next numbers. Throws ConfigError where there are not so many left.
  void read(std::span<double> numbers);
  double read();
  /// A number that counts something: throws ConfigError if it is not a whole one from 0 to `most`.
  std::size_t read_count(std::size_t most);
  [[nodiscard]] std::uint64_t left() const { return left_; }

  /// Length of the record that `bytes` begin with; 0 if its heading is none or damaged.
  static std::uint64_t bytes(std::span<const char> bytes);

private:
  const char* at_;
  std::uint64_t left_;
};

} // namespace granflux::cfd
