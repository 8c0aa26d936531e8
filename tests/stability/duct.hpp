// SPDX-FileCopyrightText: 2026 The GranFlux developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cmath>
#include <numbers>

#include <granflux/cfd/case_mesh.hpp>
#include <granflux/cfd/sweep.hpp>

#include "fake_host.hpp"

namespace granflux::testing {

/// A box from the origin of n cells of the given size; gas enters through "in" at z = 0 with the
/// superficial velocity u and leaves through "out"; the sides are periodic.
inline cfd::GasCase upright_duct(cfd::Index3 n, Vec3 cell, double u) {
  cfd::GasCase c;
  for (std::size_t d = 0; d < 3; ++d)
    box_grid(c).nodes[d] = cfd::uniform_nodes(0, n[d] * cell[int(d)], n[d]);
  box_grid(c).periodic = {true, true, false};
  box_grid(c).patches = {{"in", {2, false}}, {"out", {2, true}}};
  c.boundaries = {{.name = "in", .kind = cfd::BoundaryKind::inlet, .velocity = {0, 0, u}},
                  {.name = "out", .kind = cfd::BoundaryKind::outlet}};
  return c;
}

/// A closed box of n cubes of the given size between walls without friction.
inline cfd::GasCase closed_box(cfd::Index3 n, double cell) {
  cfd::GasCase c;
  for (std::size_t d = 0; d < 3; ++d) {
    box_grid(c).nodes[d] = cfd::uniform_nodes(0, n[d] * cell, n[d]);
    for (const bool high : {false, true}) {
      const std::string name = std::string(1, "xyz"[d]) + (high ? "_high" : "_low");
      box_grid(c).patches.push_back({name, {int(d), high}});
      c.boundaries.push_back({.name = name, .kind = cfd::BoundaryKind::slip});
    }
  }
  return c;
}

/// Spheres on a simple cubic lattice of constant a, n of them along each direction.
inline void add_lattice(FakeHost& host, cfd::Index3 n, double a, double diameter, double density,
                        bool fixed) {
  std::int64_t id = 1;
  for (int k = 0; k < n[2]; ++k)
    for (int j = 0; j < n[1]; ++j)
      for (int i = 0; i < n[0]; ++i)
        host.add(sphere(id++, {(i + 0.5) * a, (j + 0.5) * a, (k + 0.5) * a}, {}, diameter / 2,
                        density, fixed));
}

/// Lattice constant of simple cubic packing at a void fraction; spheres held in place may overlap.
inline double lattice_constant(double diameter, double void_fraction) {
  return diameter * std::cbrt(std::numbers::pi / 6 / (1 - void_fraction));
}

/// Ergun's pressure gradient at the superficial velocity u [Pa/m].
inline double ergun(double eps, double d, double rho, double mu, double u) {
  const double e3 = eps * eps * eps;
  return 150 * (1 - eps) * (1 - eps) / e3 * mu * u / (d * d) +
         1.75 * (1 - eps) / e3 * rho * u * u / d;
}

inline double pressure_drop(coupling::Coupler& coupler) {
  return coupler.gas().boundary_pressure("in") - coupler.gas().boundary_pressure("out");
}

/// Largest of value(block, cell) over all cells and ranks; not-a-number is passed on.
template <class Value> double largest(const cfd::Mesh& mesh, Value&& value) {
  double most = -1e300;
  for (std::size_t b = 0; b < mesh.local.size(); ++b)
    most = cfd::max_cells(mesh.local[b].layout, most,
                          [&](std::ptrdiff_t c) { return double(value(b, c)); });
  MPI_Allreduce(MPI_IN_PLACE, &most, 1, MPI_DOUBLE, MPI_MAX, mesh.comm);
  return most;
}

} // namespace granflux::testing
