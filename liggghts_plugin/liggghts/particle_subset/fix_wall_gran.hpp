// SPDX-FileCopyrightText: 2026 The GranFlux developers
// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

#include <vector>

// LIGGGHTS' headers need this order.
#include <liggghts/vector_liggghts.h>

#include <liggghts/math_extra_liggghts.h>

#include <liggghts/fix_wall_gran.h>

#include "wall_pairs.hpp"

namespace granflux::particle_subset {

/// fix wall/gran, primitives and meshes, with every thread evaluating contacts of its own
/// particles by LIGGGHTS' own law. What would make threads meet (contacts stored or printed one by
/// one, heat of walls, energy budgets, rigid bodies, multi-contact laws) is LIGGGHTS' own.
class FixWallGran : public LAMMPS_NS::FixWallGran {
public:
  using LAMMPS_NS::FixWallGran::FixWallGran;

  void pre_neighbor() override;

protected:
  void post_force_primitive(int vflag) override;
  void post_force_mesh(int vflag) override;

private:
  struct Mesh;
  /// What one contact does to the mesh.
  struct ForceOnMesh {
    bool acts = false;
    int particle, triangle;
    double force[3], to_wall[3], wall_velocity[3]; // N on the particle, m, m/s
  };

  [[nodiscard]] const char* reason_for_stock() const;
  [[nodiscard]] bool threads_may_share();
  void touch_primitive(int particle, const double* wall_velocity);
  void evaluate_mesh(int number);
  void touch_mesh(const Mesh& mesh, int particle, int triangle, ForceOnMesh* on_mesh);

  std::vector<WallPairs> pairs_; // of each mesh
  std::vector<ForceOnMesh> forces_on_mesh_;
};

} // namespace granflux::particle_subset
