// SPDX-FileCopyrightText: 2026 The GranFlux developers
// SPDX-License-Identifier: BSD-3-Clause
#include <granflux/cfd/halo.hpp>

#include <map>

namespace granflux::cfd {

namespace {

/// Ghost cells of one patch, nearest layer first.
template <class Body> void for_ghosts(const Patch& patch, Body&& body) {
  const auto d = std::size_t(patch.side.direction);
  for (int layer = 1; layer <= ghost_layers; ++layer) {
    const int shift = patch.side.high ? layer : -layer;
    for (int k = patch.cells.lo[2]; k < patch.cells.hi[2]; ++k)
      for (int j = patch.cells.lo[1]; j < patch.cells.hi[1]; ++j)
        for (int i = patch.cells.lo[0]; i < patch.cells.hi[0]; ++i) {
          Index3 ghost{i, j, k};
          ghost[d] += shift;
          body(ghost);
        }
  }
}

} // namespace

Halo::Halo(const Mesh& mesh) : comm_(mesh.comm) {
  int rank = 0;
  MPI_Comm_rank(comm_, &rank);
  std::map<int, int> local; // block id -> index into mesh.local
  for (std::size_t b = 0; b < mesh.local.size(); ++b)
    local[mesh.local[b].id] = int(b);
  std::map<int, Message> sends, receives;

  // Every rank walks all blocks in the same order, so sender and receiver list a message's cells
  // alike without asking each other.
  for (int id = 0; id < int(mesh.blocks.size()); ++id) {
    const BlockInfo& info = mesh.blocks[std::size_t(id)];
    for (const Patch& patch : info.patches) {
      if (!patch.link)
        continue;
      for_ghosts(patch, [&](const Index3& ghost) {
        const auto donor = resolve(mesh, {id, ghost});
        if (!donor)
          return; // behind a boundary further on: the boundary condition fills it
        const int donor_rank = mesh.blocks[std::size_t(donor->block)].rank;
        const bool here = info.rank == rank, there = donor_rank == rank;
        if (!here && !there)
          return;
        const auto at = [&](int block, const Index3& cell) {
          return mesh.local[std::size_t(local.at(block))].layout.at(cell);
        };
        if (here && there)
          copies_.push_back(
              {local.at(donor->block), local.at(id), at(donor->block, donor->cell), at(id, ghost)});
        else if (here)
          receives[donor_rank].cells.emplace_back(local.at(id), at(id, ghost));
        else
          sends[info.rank].cells.emplace_back(local.at(donor->block),
                                              at(donor->block, donor->cell));
      });
    }
  }
  for (auto& [other, message] : sends)
    message.rank = other, sends_.push_back(std::move(message));
  for (auto& [other, message] : receives)
    message.rank = other, receives_.push_back(std::move(message));
}

template <class At> void Halo::exchange_values(int count, At&& at) const {
  constexpr int tag = 71;
  std::vector<std::vector<double>> in(receives_.size()), out(sends_.size());
  std::vector<MPI_Request> requests;
  requests.reserve(in.size() + out.size());
  const auto start = [&](std::vector<double>& buffer, const Message& message) {
    buffer.resize(message.cells.size() * std::size_t(count));
    requests.emplace_back();
    return &requests.back();
  };
  for (std::size_t m = 0; m < in.size(); ++m) {
    MPI_Request* request = start(in[m], receives_[m]);
    MPI_Irecv(in[m].data(), int(in[m].size()), MPI_DOUBLE, receives_[m].rank, tag, comm_, request);
  }
  for (std::size_t m = 0; m < out.size(); ++m) {
    MPI_Request* request = start(out[m], sends_[m]);
    double* to = out[m].data();
    for (int f = 0; f < count; ++f)
      for (const auto& [block, position] : sends_[m].cells)
        *to++ = at(f, block)[position];
    MPI_Isend(out[m].data(), int(out[m].size()), MPI_DOUBLE, sends_[m].rank, tag, comm_, request);
  }
  for (int f = 0; f < count; ++f)
    for (const Copy& copy : copies_)
      at(f, copy.to_block)[copy.to] = at(f, copy.from_block)[copy.from];
  MPI_Waitall(int(requests.size()), requests.data(), MPI_STATUSES_IGNORE);
  for (std::size_t m = 0; m < in.size(); ++m) {
    const double* from = in[m].data();
    for (int f = 0; f < count; ++f)
      for (const auto& [block, position] : receives_[m].cells)
        at(f, block)[position] = *from++;
  }
}

void Halo::exchange(std::initializer_list<BlockFields*> fields) const {
  exchange_values(int(fields.size()), [&](int f, int block) -> Field& {
    return (*fields.begin()[f])[std::size_t(block)];
  });
}

void Halo::exchange(BlockVectors& vectors) const {
  exchange_values(
      3, [&](int f, int block) -> Field& { return vectors[std::size_t(block)][std::size_t(f)]; });
}

} // namespace granflux::cfd
