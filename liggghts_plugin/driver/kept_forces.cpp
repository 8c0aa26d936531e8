// SPDX-FileCopyrightText: 2026 The GranFlux developers
// SPDX-License-Identifier: GPL-2.0-or-later
#include "kept_forces.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <span>
#include <stdexcept>
#include <string>
#include <vector>

#include <granflux/cfd/error.hpp>
#include <granflux/cfd/state_record.hpp>

namespace granflux::driver {

namespace {

using cfd::RecordReader;
using cfd::RecordWriter;

constexpr char kind[] = "checkpoint";
constexpr int columns = KeptForces::saved - 1; ///< whether there are any, force, torque
using Numbers = std::array<double, sizeof(KeptForces::Step) / sizeof(double)>;

} // namespace

void KeptForces::write(const std::optional<Step>& step, std::FILE* file) {
  const std::size_t count = step ? std::tuple_size_v<Numbers> : 0;
  const int size = int(RecordWriter::bytes(count));
  bool good = std::fwrite(&size, sizeof size, 1, file) == 1;
  RecordWriter out(kind, count, [&](const void* bytes, std::size_t n) {
    good = std::fwrite(bytes, 1, n, file) == n && good;
  });
  if (step)
    out.write(std::bit_cast<Numbers>(*step));
  out.finish();
  if (!good)
    throw std::runtime_error("the restart file could not be written: is the disk full?");
}

void KeptForces::read(const char* block, int n) {
  const std::size_t heading = sizeof(cfd::RecordHeading);
  const std::uint64_t size = RecordReader::bytes({block, heading});
  RecordReader in(kind, {block, std::max<std::size_t>(size, heading)});
  if (in.left() == 0)
    return;
  Numbers numbers{};
  in.read(numbers);
  step_ = std::bit_cast<Step>(numbers);
  rows_.emplace(std::vector<double>(columns));
  rows_->grow(n);
}

int KeptForces::pack(const double* force, const double* torque, double* buffer) {
  std::fill_n(buffer, saved, 0);
  buffer[0] = saved;
  if (force) {
    buffer[1] = 1;
    std::copy_n(force, 3, buffer + 2);
    std::copy_n(torque, 3, buffer + 5);
  }
  return saved;
}

void KeptForces::restore(double** force, double** torque, int n) {
  const auto rows = rows_->view<std::array<double, columns>>(n);
  for (int i = 0; i < n; ++i) {
    const std::array<double, columns>& row = rows[std::size_t(i)];
    if (row[0] == 0)
      continue;
    std::copy_n(&row[1], 3, force[i]);
    std::copy_n(&row[4], 3, torque[i]);
  }
}

} // namespace granflux::driver
