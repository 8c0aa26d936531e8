// SPDX-FileCopyrightText: 2026 The GranFlux developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <vector>

#include <granflux/cfd/gas_case.hpp>
#include <granflux/cfd/mesh.hpp>

namespace granflux::cfd {

/// One boundary face of a local block.
struct BoundaryFace {
  std::ptrdiff_t cell;  ///< the interior cell
  std::ptrdiff_t ghost; ///< the cell mirrored beyond the face
  std::ptrdiff_t inner; ///< the next cell inwards, or `cell` itself where there is none
  std::ptrdiff_t face;  ///< position in fields on faces of the patch's direction
  double shape;         ///< of the inlet profile at this face; its mean over the boundary is 1
};

/// The faces of one boundary condition on one side of one local block.
struct BoundaryPatch {
  int block = 0;      ///< index into Mesh::local
  int direction = 0;  ///< normal of the faces
  double outward = 1; ///< +1: the area vectors point out of the domain; -1: into it
  int condition = 0;  ///< index into Boundaries::conditions
  std::vector<BoundaryFace> faces;
};

/// Boundary conditions bound to the faces of a mesh; fills ghost cells so that the interior
/// stencils need no special case.
class Boundaries {
public:
  /// Throws ConfigError where names of mesh and conditions do not match, or a wall's velocity
  /// points through the wall.
  Boundaries(const Mesh& mesh, const std::vector<BoundaryCondition>& conditions);

  [[nodiscard]] const std::vector<BoundaryCondition>& conditions() const { return conditions_; }
  [[nodiscard]] const std::vector<BoundaryPatch>& patches() const { return patches_; }
  [[nodiscard]] const BoundaryCondition& condition(const BoundaryPatch& p) const {
    return conditions_[std::size_t(p.condition)];
  }
  [[nodiscard]] bool has_outlet() const;

  /// Superficial velocity on a face at a time [m/s]; zero except on inlets and moving walls.
  [[nodiscard]] Vec3 velocity(const BoundaryPatch& patch, const BoundaryFace& face,
                              double time) const;
  /// Ghosts of the interstitial velocity; a ghost and its cell average to the boundary value.
  void fill_velocity(BlockVectors& velocity, const BlockFields& void_fraction, double time) const;
  /// Of a correction to velocity component m: its ghost in units of the cell inside.
  [[nodiscard]] double velocity_ghost_factor(const BoundaryPatch& patch, const BoundaryFace& face,
                                             int m) const;
  /// Ghosts of the pressure: outlet value (0 if not `with_given`), else continued from inside,
  /// linearly but for the part of the gradient that balances drag, which may jump between cells.
  void fill_pressure(BlockFields& pressure, const BlockVectors& drag_slope, bool with_given) const;
  /// Corrects these ghosts, but those of outlets, where their centres are not on the line that the
  /// pressure was continued along. `slope`: gradient of the pressure in the cells [Pa/m].
  void move_pressure_ghosts(BlockFields& pressure, const BlockVectors& slope) const;
  /// Ghosts of the temperature. `conductance`: k eps_f |S|^2/(S.dx) on low faces [W/K].
  void fill_temperature(BlockFields& temperature,
                        const std::vector<std::array<Field, 3>>& conductance) const;
  /// The same of a correction to the temperature.
  [[nodiscard]] double temperature_ghost_factor(const BoundaryPatch& patch) const;
  /// Ghosts equal to their cells.
  void fill_zero_gradient(BlockFields& field) const;

private:
  const Mesh& mesh_;
  std::vector<BoundaryCondition> conditions_;
  std::vector<BoundaryPatch> patches_;
};

} // namespace granflux::cfd
