// SPDX-FileCopyrightText: 2026 The GranFlux developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

namespace granflux::cfd {

/// CRC-64/XZ (ECMA-182, reflected): finds every damage within 64 bits, and any other but for one in
/// 2^64. Eight bytes at a time by as many tables.
class Checksum {
public:
  void add(const void* bytes, std::size_t count);
  [[nodiscard]] std::uint64_t value() const { return ~rest_; }

private:
  std::uint64_t rest_ = ~std::uint64_t{0};
};

} // namespace granflux::cfd
