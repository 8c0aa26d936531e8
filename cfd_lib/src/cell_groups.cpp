// SPDX-FileCopyrightText: 2026 The GranFlux developers
// SPDX-License-Identifier: BSD-3-Clause
#include "cell_groups.hpp"

#include <algorithm>

namespace granflux::cfd {

void CellGroups::start(int nodes) {
  const auto n = std::size_t(nodes);
  diagonal_.assign(n, 0.0);
  coupling_.assign(n * n, 0.0);
}

void CellGroups::add_coupling(int a, int b, double more) {
  coupling(a, b) += more;
  coupling(b, a) += more;
}

int CellGroups::join(double least) {
  const int n = int(diagonal_.size());
  group_.resize(std::size_t(n));
  inverse_.resize(std::size_t(n));
  heads_.resize(std::size_t(n));
  for (int a = 0; a < n; ++a) {
    const auto at = std::size_t(a);
    group_[at] = heads_[at] = a;
    inverse_[at] = diagonal_[at] > 0 ? 1 / diagonal_[at] : 0;
  }
  while (heads_.size() > 1) {
    double best = -1;
    std::size_t into = 0, from = 0;
    for (std::size_t p = 0; p < heads_.size(); ++p)
      for (std::size_t q = p + 1; q < heads_.size(); ++q) {
        const int a = heads_[p], b = heads_[q];
        const double sum = inverse_[std::size_t(a)] + inverse_[std::size_t(b)];
        // What couples to nothing at all may go anywhere.
        const bool free = inverse_[std::size_t(a)] == 0 || inverse_[std::size_t(b)] == 0;
        const double quality = free ? 1 : coupling(a, b) * sum;
        if (quality > best)
          best = quality, into = p, from = q;
      }
    if (!(best >= least))
      break;
    const int a = heads_[into], b = heads_[from];
    diagonal_[std::size_t(a)] += diagonal_[std::size_t(b)];
    inverse_[std::size_t(a)] = diagonal_[std::size_t(a)] > 0 ? 1 / diagonal_[std::size_t(a)] : 0;
    heads_.erase(heads_.begin() + std::ptrdiff_t(from));
    for (const int c : heads_)
      if (c != a)
        coupling(a, c) = coupling(c, a) = coupling(a, c) + coupling(b, c);
    std::replace(group_.begin(), group_.end(), b, a);
  }
  for (int& group : group_)
    group = int(std::lower_bound(heads_.begin(), heads_.end(), group) - heads_.begin());
  return int(heads_.size());
}

} // namespace granflux::cfd
