// SPDX-FileCopyrightText: 2026 The GranFlux developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cmath>
#include <random>
#include <vector>

#include <granflux/cfd/box_mesh.hpp>

namespace granflux::coupling {

/// Nodes whose cells grow by a factor from one to the next.
inline std::vector<double> stretched_nodes(double origin, double length, int n, double factor) {
  std::vector<double> nodes{0};
  for (int i = 0; i < n; ++i)
    nodes.push_back(nodes.back() + std::pow(factor, i));
  const double sum = nodes.back();
  for (double& x : nodes)
    x = origin + x / sum * length;
  nodes.back() = origin + length;
  return nodes;
}

/// Uniform along x, stretched along y and z, not at the origin.
inline cfd::Lattice sample_lattice(std::array<bool, 3> periodic) {
  cfd::Lattice lattice;
  lattice.nodes = {cfd::uniform_nodes(-0.3, 1, 10), stretched_nodes(1, 2, 7, 1.3),
                   stretched_nodes(0, 1.5, 5, 0.8)};
  lattice.periodic = periodic;
  lattice.starts = {{{0, 10}, {0, 7}, {0, 5}}};
  return lattice;
}

/// A point in the box, now and then on a face, an edge or a corner of a cell.
template <class Random> Vec3 sample_point(const cfd::Lattice& lattice, Random& random) {
  Vec3 x;
  for (int d = 0; d < 3; ++d) {
    const auto& nodes = lattice.nodes[std::size_t(d)];
    if (random() % 4 == 0)
      x[d] = nodes[random() % nodes.size()];
    else
      x[d] = std::uniform_real_distribution(nodes.front(), nodes.back())(random);
  }
  return x;
}

} // namespace granflux::coupling
