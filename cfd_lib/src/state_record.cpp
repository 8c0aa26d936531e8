// SPDX-FileCopyrightText: 2026 The GranFlux developers
// SPDX-License-Identifier: BSD-3-Clause
#include <granflux/cfd/state_record.hpp>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <stdexcept>
#include <string>
#include <utility>

#include <granflux/cfd/error.hpp>

namespace granflux::cfd {

namespace {

constexpr std::uint64_t format = 0x0102030400000002; // the last is its number

std::array<char, 16> padded(std::string_view text) {
  std::array<char, 16> out{};
  std::ranges::copy(text.substr(0, out.size() - 1), out.begin());
  return out;
}

const std::array<char, 16> magic = padded(record_magic);

std::uint64_t checksum_of(const RecordHeading& heading) {
  Checksum sum;
  sum.add(&heading, offsetof(RecordHeading, checksum));
  return sum.value();
}

[[noreturn]] void torn() {
  throw ConfigError("the file is incomplete or damaged: use an earlier one");
}

/// Nothing but what is certain of the bytes' start.
RecordHeading heading_of(std::span<const char> bytes) {
  RecordHeading heading;
  if (bytes.size() >= sizeof heading)
    std::memcpy(&heading, bytes.data(), sizeof heading);
  return heading;
}

} // namespace

RecordWriter::RecordWriter(std::string_view kind, std::uint64_t count, Sink sink)
    : sink_(std::move(sink)), left_(count) {
  RecordHeading heading{
      .magic = magic, .kind = padded(kind), .format = format, .count = count, .checksum = 0};
  heading.checksum = checksum_of(heading);
  sink_(&heading, sizeof heading);
}

void RecordWriter::write(std::span<const double> numbers) {
  if (numbers.size() > left_)
    throw std::logic_error("a record gets more numbers than it was announced with");
  left_ -= numbers.size();
  finite_ = finite_ && std::ranges::all_of(numbers, [](double x) { return std::isfinite(x); });
  sum_.add(numbers.data(), numbers.size_bytes());
  sink_(numbers.data(), numbers.size_bytes());
}

void RecordWriter::finish() {
  if (left_ != 0)
    throw std::logic_error("a record gets fewer numbers than it was announced with");
  const std::uint64_t sum = sum_.value();
  sink_(&sum, sizeof sum);
}

RecordReader::RecordReader(std::string_view kind, std::span<const char> bytes)
    : at_(bytes.data() + sizeof(RecordHeading)) {
  const RecordHeading heading = heading_of(bytes);
  if (heading.magic != magic)
    throw ConfigError("this is no state that GranFlux has written, or one of an earlier version");
  if (heading.checksum != checksum_of(heading))
    torn();
  if (heading.format != format)
    throw ConfigError("it was written by another version of GranFlux, or on a machine with "
                      "another order of bytes");
  if (heading.kind != padded(kind))
    throw ConfigError(std::string("it holds the state of \"") + heading.kind.data() +
                      "\", not of \"" + std::string(kind) + "\"");
  left_ = heading.count;
  const std::uint64_t room = bytes.size() - sizeof heading;
  if (left_ >= room / 8)
    torn();
  Checksum sum;
  sum.add(at_, 8 * left_);
  std::uint64_t expected = 0;
  std::memcpy(&expected, at_ + 8 * left_, 8);
  if (sum.value() != expected)
    torn();
}

void RecordReader::read(std::span<double> numbers) {
  if (numbers.size() > left_)
    throw ConfigError(
        "it holds fewer numbers than this run needs: another grid or other equations");
  if (numbers.empty()) // then it may have no address
    return;
  std::memcpy(numbers.data(), at_, numbers.size_bytes());
  at_ += numbers.size_bytes();
  left_ -= numbers.size();
}

double RecordReader::read() {
  double number = 0;
  read({&number, 1});
  return number;
}

std::size_t RecordReader::read_count(std::size_t most) {
  const double number = read();
  if (!(number >= 0 && number <= double(most)) || number != std::floor(number))
    throw ConfigError("it holds another grid or other equations than this run");
  return std::size_t(number);
}

std::uint64_t RecordReader::bytes(std::span<const char> bytes) {
  const RecordHeading heading = heading_of(bytes);
  const bool good = heading.magic == magic && heading.checksum == checksum_of(heading);
  return good ? RecordWriter::bytes(heading.count) : 0;
}

} // namespace granflux::cfd
