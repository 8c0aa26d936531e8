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
  uniform_ = true;
  for (std::size_t i = 0; i < nodes.size(); ++i)
    uniform_ = uniform_ && std::abs((nodes[i] - nodes[0]) * per_length_ - double(i)) < 0.01;
}

int LatticeAxis::within(double x) const {
  if (!uniform_) {
    const auto above = std::upper_bound(nodes_.begin() + 1, nodes_.end() - 1, x);
    return int(above - nodes_.begin()) - 1;
  }
  // The product may miss by one next to a face: the nodes decide.
  int i = std::clamp(int((x - nodes_.front()) * per_length_), 0, cells_ - 1);
  if (x < nodes_[std::size_t(i)])
    i = std::max(i - 1, 0);
  else if (i + 1 < cells_ && x >= nodes_[std::size_t(i) + 1])
    ++i;
  return i;
}

std::optional<int> LatticeAxis::cell(double x) const {
  if (nodes_.front() <= x && x < nodes_.back())
    return within(x);
  if (!periodic_)
    return x == nodes_.back() ? std::optional(cells_ - 1) : std::nullopt;
  const double periods = std::floor((x - nodes_.front()) / length());
  if (!(std::abs(periods) < 1000)) // not a number, or so far off that the index may overflow
    return std::nullopt;
  return within(x - periods * length()) + cells_ * int(periods);
}

int LatticeAxis::wrap(int i) const {
  if (!periodic_ || (0 <= i && i < cells_))
    return i;
  const int rest = i % cells_;
  return rest < 0 ? rest + cells_ : rest;
}

double LatticeAxis::centre(int i) const {
  if (0 <= i && i < cells_)
    return centres_[std::size_t(i)];
  const int wrapped = wrap(i);
  return centres_[std::size_t(wrapped)] + (i - wrapped) / cells_ * length();
}

double LatticeAxis::fold(double x) const {
  if (!periodic_ || std::abs(x - 0.5 * (nodes_.front() + nodes_.back())) <= 1.5 * length())
    return x;
  return x - std::floor((x - nodes_.front()) / length()) * length();
}

LatticeLocator::LatticeLocator(const cfd::Lattice& lattice) {
  for (std::size_t d = 0; d < 3; ++d)
    axes_[d] = LatticeAxis(lattice.nodes[d], lattice.periodic[d]);
}

std::optional<cfd::Index3> LatticeLocator::cell(const Vec3& x) const {
  const auto i = axes_[0].cell(x.x), j = axes_[1].cell(x.y), k = axes_[2].cell(x.z);
  if (!i || !j || !k)
    return std::nullopt;
  return cfd::Index3{*i, *j, *k};
}

} // namespace granflux::coupling
