// SPDX-FileCopyrightText: 2026 The GranFlux developers
// SPDX-License-Identifier: BSD-3-Clause
#include <granflux/cfd/pressure_solver.hpp>

namespace granflux::cfd {

namespace {

/// Measured with cubes of cells: 10^3 take 1.3 ms directly, 0.6 ms by multigrid to 1e-10; 8^3 take
/// 0.3 and 0.2 ms, and the direct solver leaves no error.
constexpr long largest_direct = 1000;

} // namespace

std::unique_ptr<PressureSolver> make_pressure_solver(PressureMethod method, const Mesh& mesh,
                                                     bool singular, double tolerance) {
  if (method == PressureMethod::automatic) {
    long cells = 0;
    for (const BlockInfo& info : mesh.blocks)
      cells += long(info.cells[0]) * info.cells[1] * info.cells[2];
    method = cells <= largest_direct ? PressureMethod::direct : PressureMethod::multigrid;
  }
  if (method == PressureMethod::direct)
    return make_eigen_pressure_solver(mesh, singular, tolerance);
  if (method == PressureMethod::hypre)
    return make_hypre_pressure_solver(mesh, singular, tolerance);
  return make_multigrid_pressure_solver(mesh, singular, tolerance);
}

} // namespace granflux::cfd
