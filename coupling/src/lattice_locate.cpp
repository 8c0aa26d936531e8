// SPDX-FileCopyrightText: 2026 The GranFlux developers
// SPDX-License-Identifier: BSD-3-Clause
#include <granflux/coupling/lattice_locate.hpp>

#include <algorithm>
#include <cmath>

namespace granflux::coupling {

LatticeAxis::LatticeAxis(const std::vector<double>& nodes, bool periodic)
    : nodes_(nodes), centres_(nodes.size() - 1), cells_(int(nodes.size()) - 1),
      periodic_(periodic) {
  for (std::size_t i = 0; i < centres_.size(); ++i)
    centres_[i] = 0.5 * (nodes[i] + nodes[i + 1]);
  per_length_ = cells_ / length();
  double off = 0; // in cells, of a node from where equal cells would have it
  for (std::size_t i = 0; i < nodes.size(); ++i)
    off = std::max(off, std::abs((nodes[i] - nodes[0]) * per_length_ - double(i)));
  uniform_ = off < 0.01;
  equal_ = off < 1e-12 * cells_;
  if (equal_ && (periodic || cells_ > 1))
    pairs_ = LinearPlace{.first = nodes.front(),
                         .last = nodes.back(),
                         .per_length = per_length_,
                         .least = periodic ? -1. : 0.,
                         .most = periodic ? cells_ : cells_ - 2.};
}

LatticeLocator::LatticeLocator(const cfd::Lattice& lattice) {
  for (std::size_t d = 0; d < 3; ++d) {
    axes_[d] = LatticeAxis(lattice.nodes[d], lattice.periodic[d]);
    extent_.low[int(d)] = lattice.nodes[d].front();
    extent_.high[int(d)] = lattice.nodes[d].back();
  }
  extent_.periodic = lattice.periodic;
}

std::optional<CellRow<2>> LatticeAxis::searched_row(double x) const {
  const std::optional<int> in = cell(x);
  if (!in)
    return std::nullopt;
  const int lower = x < centre(*in) ? *in - 1 : *in;
  if (!periodic_ && (lower < 0 || lower + 1 >= cells_))
    return inner(lower, 0);
  const double below = centre(lower), above = centre(lower + 1);
  return CellRow<2>{lower, {(x - below) / (above - below)}};
}

} // namespace granflux::coupling
