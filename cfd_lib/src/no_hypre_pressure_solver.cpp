// SPDX-FileCopyrightText: 2026 The GranFlux developers
// SPDX-License-Identifier: BSD-3-Clause

// In the place of hypre_pressure_solver.cpp where hypre was not found.

#include <granflux/cfd/pressure_solver.hpp>

#include <granflux/cfd/error.hpp>

namespace granflux::cfd {

std::unique_ptr<PressureSolver> make_hypre_pressure_solver(const Mesh&, bool, double) {
  throw ConfigError("pressure_solver = \"hypre\": this program was built without hypre; install "
                    "the package libhypre-dev and build again, or take \"multigrid\"");
}

} // namespace granflux::cfd
