// SPDX-FileCopyrightText: 2026 The GranFlux developers
// SPDX-License-Identifier: BSD-3-Clause
#include "graph_halo.hpp"

#include <utility>

namespace granflux::cfd {

namespace {

constexpr int tag = 72;

} // namespace

GraphHalo::GraphHalo(MPI_Comm comm, int own, std::vector<RemoteNode> ghosts)
    : comm_(comm), own_(own), ghosts_(std::move(ghosts)) {
  int ranks = 1;
  MPI_Comm_size(comm, &ranks);
  std::vector<int> wanted(std::size_t(ranks), 0), asked(wanted), numbers;
  for (const RemoteNode& ghost : ghosts_) {
    if (wanted[std::size_t(ghost.rank)]++ == 0)
      receives_.push_back({ghost.rank, int(numbers.size()), 0});
    ++receives_.back().count;
    numbers.push_back(ghost.number);
  }
  MPI_Alltoall(wanted.data(), 1, MPI_INT, asked.data(), 1, MPI_INT, comm);
  std::vector<MPI_Request> requests;
  for (int rank = 0; rank < ranks; ++rank)
    if (asked[std::size_t(rank)] > 0)
      sends_.push_back({rank, std::vector<int>(std::size_t(asked[std::size_t(rank)]))});
  for (Message& message : sends_) {
    requests.emplace_back();
    MPI_Irecv(message.nodes.data(), int(message.nodes.size()), MPI_INT, message.rank, tag, comm,
              &requests.back());
  }
  for (const Range& range : receives_) {
    requests.emplace_back();
    MPI_Isend(numbers.data() + range.first, range.count, MPI_INT, range.rank, tag, comm,
              &requests.back());
  }
  MPI_Waitall(int(requests.size()), requests.data(), MPI_STATUSES_IGNORE);
}

template <class Value>
void GraphHalo::exchange_values(std::vector<Value>& values, MPI_Datatype type) const {
  if (sends_.empty() && receives_.empty())
    return;
  std::vector<MPI_Request> requests;
  for (const Range& range : receives_) {
    requests.emplace_back();
    MPI_Irecv(values.data() + own_ + range.first, range.count, type, range.rank, tag, comm_,
              &requests.back());
  }
  std::vector<std::vector<Value>> out;
  for (const Message& message : sends_) {
    out.emplace_back();
    for (const int node : message.nodes)
      out.back().push_back(values[std::size_t(node)]);
    requests.emplace_back();
    MPI_Isend(out.back().data(), int(out.back().size()), type, message.rank, tag, comm_,
              &requests.back());
  }
  MPI_Waitall(int(requests.size()), requests.data(), MPI_STATUSES_IGNORE);
}

template void GraphHalo::exchange_values(std::vector<float>&, MPI_Datatype) const;
template void GraphHalo::exchange_values(std::vector<int>&, MPI_Datatype) const;

} // namespace granflux::cfd
