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
}

LatticeLocator::LatticeLocator(const cfd::Lattice& lattice) {
  for (std::size_t d = 0; d < 3; ++d) {
    axes_[d] = LatticeAxis(lattice.nodes[d], lattice.periodic[d]);
    extent_.low[int(d)] = lattice.nodes[d].front();
    extent_.high[int(d)] = lattice.nodes[d].back();
  }
  extent_.periodic = lattice.periodic;
}

} // namespace granflux::coupling
