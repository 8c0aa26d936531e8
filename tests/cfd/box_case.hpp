// SPDX-FileCopyrightText: 2026 The GranFlux developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cmath>
#include <numbers>

#include <granflux/cfd/case_mesh.hpp>
#include <granflux/cfd/gas_solver.hpp>

namespace granflux::cfd::testing {

inline constexpr double pi = std::numbers::pi;

/// A box of n cells from the origin to `size`; sides that are not periodic are walls named x_low
/// and so on, until a test changes them.
inline GasCase box_case(Index3 n, Vec3 size, std::array<bool, 3> periodic,
                        Index3 blocks = {0, 0, 0}) {
  GasCase out;
  for (int d = 0; d < 3; ++d)
    box_grid(out).nodes[std::size_t(d)] = uniform_nodes(0, size[d], n[std::size_t(d)]);
  box_grid(out).periodic = periodic;
  box_grid(out).blocks = blocks;
  for (int d = 0; d < 3; ++d)
    for (const bool high : {false, true})
      if (!periodic[std::size_t(d)]) {
        const std::string name = std::string(1, "xyz"[d]) + (high ? "_high" : "_low");
        box_grid(out).patches.push_back(
            {name, {d, high}, {-1e300, -1e300, -1e300}, {1e300, 1e300, 1e300}});
        BoundaryCondition wall;
        wall.name = name;
        out.boundaries.push_back(wall);
      }
  out.fluid.density = 1;
  out.fluid.viscosity = 0.1;
  return out;
}

inline BoundaryCondition& boundary(GasCase& gas_case, const std::string& name) {
  for (BoundaryCondition& condition : gas_case.boundaries)
    if (condition.name == name)
      return condition;
  throw std::logic_error("no boundary " + name);
}

/// body(block index, position, centre) for every interior cell of this rank.
template <class Body> void for_each_cell(const Mesh& mesh, Body&& body) {
  for (std::size_t b = 0; b < mesh.local.size(); ++b) {
    const Layout& layout = mesh.local[b].layout;
    const VectorField& x = mesh.local[b].centre;
    for (int k = 0; k < layout.cells[2]; ++k)
      for (int j = 0; j < layout.cells[1]; ++j)
        for (int i = 0; i < layout.cells[0]; ++i) {
          const std::ptrdiff_t c = layout.at(i, j, k);
          body(b, c, Vec3{x[0][c], x[1][c], x[2][c]});
        }
  }
}

/// Largest value of error(block, position, centre) over all ranks.
template <class Error> double largest(const Mesh& mesh, Error&& error) {
  double worst = 0;
  for_each_cell(mesh, [&](std::size_t b, std::ptrdiff_t c, const Vec3& x) {
    const double e = std::abs(error(b, c, x));
    if (!(e <= worst))
      worst = e;
  });
  MPI_Allreduce(MPI_IN_PLACE, &worst, 1, MPI_DOUBLE, MPI_MAX, mesh.comm);
  return worst;
}

} // namespace granflux::cfd::testing
