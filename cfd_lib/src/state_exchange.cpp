// SPDX-FileCopyrightText: 2026 The GranFlux developers
// SPDX-License-Identifier: BSD-3-Clause
#include "state_exchange.hpp"

#include <algorithm>
#include <cstddef>

namespace granflux::cfd {

namespace {

constexpr int tag = 73;

/// All cells of a block, its ghosts included.
IndexBox with_ghosts(const Index3& cells) {
  IndexBox box{{}, cells};
  for (std::size_t d = 0; d < 3; ++d)
    box.lo[d] -= ghost_layers, box.hi[d] += ghost_layers;
  return box;
}

/// The cells that a block answers for, counted from its own first one: what is inside, and ghosts
/// beyond the sides of the given block.
IndexBox answered(const BlockInfo& block, const Index3& given) {
  IndexBox box{{}, block.cells};
  for (std::size_t d = 0; d < 3; ++d) {
    if (block.place.low[d] == 0)
      box.lo[d] -= ghost_layers;
    if (block.place.low[d] + block.cells[d] == given[d])
      box.hi[d] += ghost_layers;
  }
  return box;
}

std::size_t count(const IndexBox& box) {
  std::size_t n = 1;
  for (std::size_t d = 0; d < 3; ++d)
    n *= std::size_t(box.hi[d] - box.lo[d]);
  return n;
}

/// row(position of the first cell, cells) for each row of a box along i.
template <class Row> void for_rows(const IndexBox& box, Row&& row) {
  for (int k = box.lo[2]; k < box.hi[2]; ++k)
    for (int j = box.lo[1]; j < box.hi[1]; ++j)
      row(Index3{box.lo[0], j, k}, std::size_t(box.hi[0] - box.lo[0]));
}

std::vector<double> packed(const double* values, const Layout& layout, const IndexBox& box) {
  std::vector<double> out;
  out.reserve(count(box));
  for_rows(box, [&](const Index3& first, std::size_t n) {
    const double* from = values + layout.at(first);
    out.insert(out.end(), from, from + n);
  });
  return out;
}

void unpack(const std::vector<double>& from, double* values, const Layout& layout,
            const IndexBox& box) {
  const double* at = from.data();
  for_rows(box, [&](const Index3& first, std::size_t n) {
    std::copy_n(at, n, values + layout.at(first));
    at += n;
  });
}

IndexBox moved(IndexBox box, const Index3& by) {
  for (std::size_t d = 0; d < 3; ++d)
    box.lo[d] += by[d], box.hi[d] += by[d];
  return box;
}

} // namespace

StateExchange::StateExchange(const Mesh& mesh) : mesh_(mesh), blocks_of_(mesh.given.size()) {
  MPI_Comm_rank(mesh.comm, &rank_);
  for (std::size_t b = 0; b < mesh.blocks.size(); ++b)
    blocks_of_[std::size_t(mesh.blocks[b].place.block)].push_back(int(b));
}

std::uint64_t StateExchange::numbers() const {
  std::uint64_t sum = 0;
  for (const Index3& cells : mesh_.given)
    sum += Layout(cells).size;
  return sum;
}

void StateExchange::gather(const std::vector<const Field*>& field, RecordWriter* out) const {
  std::vector<double> whole, part;
  for (std::size_t g = 0; g < mesh_.given.size(); ++g) {
    const Layout given(mesh_.given[g]);
    whole.assign(rank_ == 0 ? given.size : 0, 0);
    for (const int id : blocks_of_[g]) {
      const BlockInfo& block = mesh_.blocks[std::size_t(id)];
      const IndexBox box = answered(block, given.cells);
      if (block.rank == rank_) {
        const std::size_t b = mesh_.local_index(id);
        part = packed(field[b]->data(), mesh_.local[b].layout, box);
        if (rank_ != 0)
          MPI_Send(part.data(), int(part.size()), MPI_DOUBLE, 0, tag, mesh_.comm);
      } else if (rank_ == 0) {
        part.resize(count(box));
        MPI_Recv(part.data(), int(part.size()), MPI_DOUBLE, block.rank, tag, mesh_.comm,
                 MPI_STATUS_IGNORE);
      }
      if (rank_ == 0)
        unpack(part, whole.data(), given, moved(box, block.place.low));
    }
    if (out)
      out->write(whole);
  }
}

void StateExchange::scatter(RecordReader* in, const std::vector<Field*>& field) const {
  std::vector<double> whole, part;
  for (std::size_t g = 0; g < mesh_.given.size(); ++g) {
    const Layout given(mesh_.given[g]);
    whole.resize(rank_ == 0 ? given.size : 0);
    if (in)
      in->read(whole);
    for (const int id : blocks_of_[g]) {
      const BlockInfo& block = mesh_.blocks[std::size_t(id)];
      const IndexBox box = with_ghosts(block.cells);
      if (rank_ == 0) {
        part = packed(whole.data(), given, moved(box, block.place.low));
        if (block.rank != 0)
          MPI_Send(part.data(), int(part.size()), MPI_DOUBLE, block.rank, tag, mesh_.comm);
      } else if (block.rank == rank_) {
        part.resize(count(box));
        MPI_Recv(part.data(), int(part.size()), MPI_DOUBLE, 0, tag, mesh_.comm, MPI_STATUS_IGNORE);
      }
      if (block.rank == rank_) {
        const std::size_t b = mesh_.local_index(id);
        unpack(part, field[b]->data(), mesh_.local[b].layout, box);
      }
    }
  }
}

} // namespace granflux::cfd
