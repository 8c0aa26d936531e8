// SPDX-FileCopyrightText: 2026 The GranFlux developers
// SPDX-License-Identifier: BSD-3-Clause
#include <granflux/cfd/halo.hpp>

#include <map>
#include <type_traits>

namespace granflux::cfd {

namespace {

/// Ghost cells of one patch, nearest layer first.
template <class Body> void for_ghosts(const Patch& patch, int layers, Body&& body) {
  const auto d = std::size_t(patch.side.direction);
  for (int layer = 1; layer <= layers; ++layer) {
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

Halo::Halo(const Mesh& mesh, int layers)
    : Halo(mesh, layers, [&](std::size_t block, const Index3& cell) {
        return mesh.local[block].layout.at(cell);
      }) {}

Halo::Halo(const Mesh& mesh, int layers, const Position& position) : comm_(mesh.comm) {
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
      for_ghosts(patch, layers, [&](const Index3& ghost) {
        const auto donor = resolve(mesh, {id, ghost});
        if (!donor)
          return; // behind a boundary further on: the boundary condition fills it
        const int donor_rank = mesh.blocks[std::size_t(donor->block)].rank;
        const bool here = info.rank == rank, there = donor_rank == rank;
        if (!here && !there)
          return;
        const auto at = [&](int block, const Index3& cell) {
          return position(std::size_t(local.at(block)), cell);
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

template <class Value, class At> void Halo::exchange_values(int count, At&& at) const {
  constexpr int tag = 71;
  const MPI_Datatype type = std::is_same_v<Value, double> ? MPI_DOUBLE : MPI_FLOAT;
  requests_.clear();
  const auto prepare = [&](const Message& message) {
    message.values.resize(message.cells.size() * std::size_t(count) * sizeof(Value));
    requests_.emplace_back();
    return reinterpret_cast<Value*>(message.values.data());
  };
  const auto length = [&](const Message& message) { return int(message.cells.size()) * count; };
  for (const Message& message : receives_) {
    Value* to = prepare(message);
    MPI_Irecv(to, length(message), type, message.rank, tag, comm_, &requests_.back());
  }
  for (const Message& message : sends_) {
    Value* to = prepare(message);
    for (int f = 0; f < count; ++f)
      for (const auto& [block, position] : message.cells)
        *to++ = at(f, block)[position];
    MPI_Isend(message.values.data(), length(message), type, message.rank, tag, comm_,
              &requests_.back());
  }
  for (int f = 0; f < count; ++f)
    for (const Copy& copy : copies_)
      at(f, copy.to_block)[copy.to] = at(f, copy.from_block)[copy.from];
  MPI_Waitall(int(requests_.size()), requests_.data(), MPI_STATUSES_IGNORE);
  for (const Message& message : receives_) {
    const auto* from = reinterpret_cast<const Value*>(message.values.data());
    for (int f = 0; f < count; ++f)
      for (const auto& [block, position] : message.cells)
        at(f, block)[position] = *from++;
  }
}

void Halo::exchange(std::initializer_list<BlockFields*> fields) const {
  exchange_values<double>(int(fields.size()), [&](int f, int block) -> Field& {
    return (*fields.begin()[f])[std::size_t(block)];
  });
}

void Halo::exchange(BlockVectors& vectors) const {
  exchange_values<double>(
      3, [&](int f, int block) -> Field& { return vectors[std::size_t(block)][std::size_t(f)]; });
}

void Halo::exchange(const std::vector<float*>& blocks) const {
  exchange_values<float>(1, [&](int, int block) { return blocks[std::size_t(block)]; });
}

} // namespace granflux::cfd
