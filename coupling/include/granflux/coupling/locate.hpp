// SPDX-FileCopyrightText: 2026 The GranFlux developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <variant>

#include <granflux/coupling/block_locate.hpp>
#include <granflux/coupling/lattice_locate.hpp>

namespace granflux::coupling {

/// What finds the cells of particles: cell(x), fold(x), extent().
using AnyLocator = std::variant<LatticeLocator, BlockLocator>;

/// The one that fits a mesh. Collective.
inline AnyLocator make_locator(const cfd::Mesh& mesh) {
  if (mesh.lattice)
    return LatticeLocator(*mesh.lattice);
  return BlockLocator(mesh);
}

} // namespace granflux::coupling
