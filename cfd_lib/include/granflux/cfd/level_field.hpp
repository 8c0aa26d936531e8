// SPDX-FileCopyrightText: 2026 The GranFlux developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdlib>
#include <memory>
#include <vector>

#include <granflux/cfd/field.hpp>
#include <granflux/cfd/out_of_memory.hpp>
#include <granflux/cfd/team.hpp>

namespace granflux::cfd {

/// Where the cells of a block lie in the fields of the multigrid solver: i fastest, one layer of
/// ghost cells, and every row begins at a cache line, so that vectors of a row are loaded whole.
/// Faces as in Layout.
struct LevelLayout {
  static constexpr int line = 16; ///< floats of a cache line

  Index3 cells{};
  std::array<std::ptrdiff_t, 3> stride{};
  std::ptrdiff_t origin = 0; ///< position of interior cell (0,0,0)
  std::size_t size = 0;      ///< entries, ghosts and padding included

  LevelLayout() = default;
  explicit LevelLayout(Index3 n) : cells(n) {
    const std::ptrdiff_t row = (n[0] + 2 + line - 1) / line * line;
    stride = {1, row, row * (n[1] + 2)};
    origin = line + stride[1] + stride[2];
    size = std::size_t(2 * line + stride[2] * (n[2] + 2));
  }
  /// Position of cell (i,j,k); interior for 0 <= i < cells[0], ghosts at -1 and cells[0].
  [[nodiscard]] std::ptrdiff_t at(int i, int j, int k) const {
    return origin + i + j * stride[1] + k * stride[2];
  }
  [[nodiscard]] std::ptrdiff_t at(const Index3& c) const { return at(c[0], c[1], c[2]); }
  [[nodiscard]] std::ptrdiff_t interior() const {
    return std::ptrdiff_t(cells[0]) * cells[1] * cells[2];
  }
};

/// Numbers in single precision, aligned to cache lines and 0 to begin with; touched first by the
/// threads that will sweep them.
class FloatField {
public:
  FloatField() = default;
  explicit FloatField(std::size_t size)
      : size_(size), values_(static_cast<float*>(std::aligned_alloc(alignment, bytes(size)))) {
    if (!values_)
      throw OutOfMemory(double(bytes(size)));
    const auto n = std::ptrdiff_t(bytes(size) / sizeof(float));
    float* v = values_.get();
    deal(n >= smallest_parallel_sweep, n, [=](std::ptrdiff_t c) { v[c] = 0; });
  }
  float* data() { return values_.get(); }
  [[nodiscard]] const float* data() const { return values_.get(); }
  [[nodiscard]] std::size_t size() const { return size_; }

private:
  static constexpr std::size_t alignment = 64;
  static std::size_t bytes(std::size_t size) {
    return (size * sizeof(float) + alignment - 1) / alignment * alignment;
  }
  struct Free {
    void operator()(float* p) const { std::free(p); }
  };
  std::size_t size_ = 0;
  std::unique_ptr<float[], Free> values_;
};

} // namespace granflux::cfd
