// SPDX-FileCopyrightText: 2026 The GranFlux developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <vector>

#include <granflux/cfd/mesh.hpp>

namespace granflux::cfd {

[[nodiscard]] inline std::int64_t cell_count(const Index3& cells) {
  return std::int64_t(cells[0]) * cells[1] * cells[2];
}

/// Rank of each block: each rank gets blocks that follow one another, at least one, so that the
/// largest sum of costs (> 0, say cells) is as small as it can be. Throws ConfigError where there
/// are fewer blocks than ranks.
std::vector<int> deal_blocks(const std::vector<std::int64_t>& cost, int ranks);

/// Largest cost of a rank over the mean of all: 1 is perfect.
double imbalance(const std::vector<std::int64_t>& cost, const std::vector<int>& rank_of, int ranks);
double imbalance(const Mesh& mesh);

} // namespace granflux::cfd
