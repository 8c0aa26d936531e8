// SPDX-FileCopyrightText: 2026 The GranFlux developers
// SPDX-License-Identifier: BSD-3-Clause
#include <granflux/cfd/deal_blocks.hpp>

#include <algorithm>
#include <numeric>
#include <string>

#include <granflux/cfd/error.hpp>

namespace granflux::cfd {

namespace {

/// Fills rank after rank up to a capacity; a rank also ends where the blocks left are just enough
/// to give the later ones one each. Empty where the capacity does not do.
std::vector<int> fill(const std::vector<std::int64_t>& cost, int ranks, std::int64_t capacity) {
  std::vector<int> rank_of;
  const int count = int(cost.size());
  std::int64_t load = 0;
  for (int id = 0, rank = 0; id < count; ++id) {
    const std::int64_t next = cost[std::size_t(id)];
    if (next > capacity)
      return {};
    if (id > 0 && (load + next > capacity || count - id < ranks - rank)) {
      ++rank;
      load = 0;
    }
    if (rank == ranks)
      return {};
    load += next;
    rank_of.push_back(rank);
  }
  return rank_of;
}

} // namespace

std::vector<int> deal_blocks(const std::vector<std::int64_t>& cost, int ranks) {
  if (int(cost.size()) < ranks)
    throw ConfigError("grid: " + std::to_string(cost.size()) + " blocks for " +
                      std::to_string(ranks) + " ranks: every rank needs at least one block");
  std::int64_t low = 0, high = std::accumulate(cost.begin(), cost.end(), std::int64_t{0});
  while (high - low > 1) { // `high` always does, `low` never
    const std::int64_t middle = low + (high - low) / 2;
    (fill(cost, ranks, middle).empty() ? low : high) = middle;
  }
  return fill(cost, ranks, high);
}

double imbalance(const std::vector<std::int64_t>& cost, const std::vector<int>& rank_of,
                 int ranks) {
  std::vector<std::int64_t> load(std::size_t(ranks), 0);
  for (std::size_t id = 0; id < cost.size(); ++id)
    load[std::size_t(rank_of[id])] += cost[id];
  const auto total = std::accumulate(load.begin(), load.end(), std::int64_t{0});
  return double(*std::max_element(load.begin(), load.end())) * ranks / double(total);
}

double imbalance(const Mesh& mesh) {
  std::vector<std::int64_t> cost;
  std::vector<int> rank_of;
  for (const BlockInfo& info : mesh.blocks) {
    cost.push_back(cell_count(info.cells));
    rank_of.push_back(info.rank);
  }
  int ranks = 1;
  MPI_Comm_size(mesh.comm, &ranks);
  return imbalance(cost, rank_of, ranks);
}

} // namespace granflux::cfd
