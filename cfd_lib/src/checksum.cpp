// SPDX-FileCopyrightText: 2026 The GranFlux developers
// SPDX-License-Identifier: BSD-3-Clause
#include <granflux/cfd/checksum.hpp>

#include <cstring>

namespace granflux::cfd {

namespace {

using Tables = std::array<std::array<std::uint64_t, 256>, 8>;

/// tables[n][b]: what byte b leaves behind when n more bytes of zeros have passed.
constexpr Tables make_tables() {
  constexpr std::uint64_t polynomial = 0xC96C5795D7870F42u;
  Tables tables{};
  for (std::uint64_t b = 0; b < 256; ++b) {
    std::uint64_t rest = b;
    for (int bit = 0; bit < 8; ++bit)
      rest = (rest >> 1) ^ (rest & 1 ? polynomial : 0);
    tables[0][b] = rest;
  }
  for (std::size_t n = 1; n < 8; ++n)
    for (std::size_t b = 0; b < 256; ++b)
      tables[n][b] = (tables[n - 1][b] >> 8) ^ tables[0][tables[n - 1][b] & 0xff];
  return tables;
}

constexpr Tables tables = make_tables();

} // namespace

void Checksum::add(const void* bytes, std::size_t count) {
  const auto* at = static_cast<const unsigned char*>(bytes);
  for (; count >= 8; at += 8, count -= 8) {
    std::uint64_t word = 0;
    std::memcpy(&word, at, 8);
    word ^= rest_;
    rest_ = 0;
    for (std::size_t n = 0; n < 8; ++n)
      rest_ ^= tables[7 - n][(word >> (8 * n)) & 0xff];
  }
  for (; count > 0; ++at, --count)
    rest_ = (rest_ >> 8) ^ tables[0][(rest_ ^ *at) & 0xff];
}

} // namespace granflux::cfd
