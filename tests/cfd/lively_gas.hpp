// SPDX-FileCopyrightText: 2026 The GranFlux developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cmath>
#include <mpi.h>
#include <string>

#include <granflux/cfd/gas_solver.hpp>
#include <granflux/cfd/sweep.hpp>

#include "box_case.hpp"
#include "skewed_square.hpp"

/// A gas in which all that a checkpoint keeps is at work.
namespace granflux::cfd::testing {

inline int rank() {
  int r = 0;
  MPI_Comm_rank(MPI_COMM_WORLD, &r);
  return r;
}

inline std::string file_name(const std::string& what) {
  int ranks = 1;
  MPI_Comm_size(MPI_COMM_WORLD, &ranks);
  return "checkpoint_" + what + "_" + std::to_string(ranks) + ".chk";
}

inline GasCase lively_case(TimeScheme scheme, double smagorinsky) {
  GasCase c;
  c.fluid.density = 1;
  c.fluid.viscosity = 0.02;
  c.fluid.smagorinsky = smagorinsky;
  c.fluid.gravity = {0, -9.81, 0};
  c.energy = Energy{.initial_temperature = 300, .expansion = 0.01, .reference_temperature = 300};
  c.numerics.time_scheme = scheme;
  return c;
}

inline void start(GasSolver& gas) {
  const Mesh& mesh = gas.mesh();
  BlockVectors u = make_vectors(mesh);
  BlockFields temperature = make_fields(mesh);
  for_each_cell(mesh, [&](std::size_t b, std::ptrdiff_t p, const Vec3& x) {
    u[b][0][p] = std::sin(2 * pi * x.y), u[b][1][p] = std::cos(2 * pi * x.x);
    temperature[b][p] = 300 + 20 * std::sin(2 * pi * x.x);
  });
  gas.initialise(make_fields(mesh, 1), u);
  gas.set_temperature(temperature);
}

} // namespace granflux::cfd::testing
