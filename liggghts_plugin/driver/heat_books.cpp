// SPDX-FileCopyrightText: 2026 The GranFlux developers
// SPDX-License-Identifier: GPL-2.0-or-later

#include "heat_books.hpp"

#include <cstring>
#include <stdexcept>
#include <vector>

#include <fmt/core.h>

#include <granflux/cfd/error.hpp>

namespace granflux::driver {

namespace {

/// Of the block; the books of the ranks follow.
struct Header {
  double format = 1;
  double ranks = 0;
  double begun = 0; ///< 1: there is a heat at the start
  double heat_at_start = 0;
};

constexpr int book_doubles = sizeof(HeatBooks) / sizeof(double);

} // namespace

void HeatBooks::book(const HeatPowers& powers, double dt) {
  conduction += dt * powers.conduction;
  walls += dt * powers.walls;
  friction += dt * powers.friction;
  damping += dt * powers.damping;
  convection += dt * powers.convection;
  source += dt * powers.source;
  to_walls += dt * powers.to_walls;
  held += dt * powers.held;
  radiation += dt * powers.radiation;
}

HeatBooks& HeatBooks::operator+=(const HeatBooks& o) & {
  conduction += o.conduction;
  walls += o.walls;
  friction += o.friction;
  damping += o.damping;
  convection += o.convection;
  source += o.source;
  to_walls += o.to_walls;
  held += o.held;
  radiation += o.radiation;
  return *this;
}

HeatPowers HeatBooks::value() const {
  return {.conduction = conduction.value(),
          .walls = walls.value(),
          .friction = friction.value(),
          .damping = damping.value(),
          .convection = convection.value(),
          .source = source.value(),
          .to_walls = to_walls.value(),
          .held = held.value(),
          .radiation = radiation.value()};
}

void write_heat_books(const HeatBooks& mine, std::optional<double> heat_at_start, std::FILE* file,
                      MPI_Comm comm) {
  int rank = 0, ranks = 1;
  MPI_Comm_rank(comm, &rank);
  MPI_Comm_size(comm, &ranks);
  std::vector<HeatBooks> all(rank == 0 ? std::size_t(ranks) : 0);
  MPI_Gather(&mine, book_doubles, MPI_DOUBLE, all.data(), book_doubles, MPI_DOUBLE, 0, comm);
  if (rank != 0)
    return;
  const Header header{.ranks = double(ranks),
                      .begun = heat_at_start ? 1. : 0.,
                      .heat_at_start = heat_at_start.value_or(0)};
  const int size = int(sizeof header + all.size() * sizeof(HeatBooks));
  bool written = std::fwrite(&size, sizeof size, 1, file) == 1;
  written = std::fwrite(&header, sizeof header, 1, file) == 1 && written;
  written = std::fwrite(all.data(), sizeof(HeatBooks), all.size(), file) == all.size() && written;
  if (!written)
    throw std::runtime_error("the restart file could not be written: is the disk full?");
}

HeatBooks read_heat_books(const char* block, std::optional<double>& heat_at_start, MPI_Comm comm) {
  int rank = 0, ranks = 1;
  MPI_Comm_rank(comm, &rank);
  MPI_Comm_size(comm, &ranks);
  Header header;
  std::memcpy(&header, block, sizeof header);
  if (header.format != Header{}.format)
    throw ConfigError(fmt::format("the restart file holds books of heat of format {}; this program "
                                  "reads format {}",
                                  header.format, Header{}.format));
  heat_at_start.reset();
  if (header.begun != 0)
    heat_at_start = header.heat_at_start;
  std::vector<HeatBooks> all(std::size_t(header.ranks));
  std::memcpy(all.data(), block + sizeof header, all.size() * sizeof(HeatBooks));
  if (int(header.ranks) == ranks)
    return all[std::size_t(rank)];
  HeatBooks sum;
  if (rank == 0)
    for (const HeatBooks& one : all)
      sum += one;
  return sum;
}

} // namespace granflux::driver
