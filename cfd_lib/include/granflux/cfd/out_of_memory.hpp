// SPDX-FileCopyrightText: 2026 The GranFlux developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <new>

namespace granflux {

/// Memory that this rank asked for and did not get. The text says what the rank holds, and what
/// helps; it is kept in place, since there is nothing left to allocate it from.
class OutOfMemory : public std::bad_alloc {
public:
  /// `wanted`: bytes; 0 where it is not known.
  explicit OutOfMemory(double wanted = 0) noexcept;
  [[nodiscard]] const char* what() const noexcept override { return text_.data(); }

private:
  std::array<char, 256> text_{};
};

/// From here on `new` throws OutOfMemory. For the start of a program.
void explain_out_of_memory();

} // namespace granflux
