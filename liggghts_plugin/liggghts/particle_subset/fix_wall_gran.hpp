// SPDX-FileCopyrightText: 2026 The GranFlux developers
// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

#include <atomic>
#include <memory>
#include <string>
#include <vector>

// LIGGGHTS' headers need this order.
#include <liggghts/vector_liggghts.h>

#include <liggghts/math_extra_liggghts.h>

#include <liggghts/fix_wall_gran.h>

#include "gran_words.hpp"
#include "heat_port.hpp"
#include "own_work.hpp"
#include "particles.hpp"
#include "standing_contacts.hpp"
#include "wall_kernel.hpp"
#include "wall_pairs.hpp"

namespace granflux::particle_subset {

/// fix wall/gran, primitives and meshes, with every thread evaluating contacts of its own
/// particles, by a law of particle_subset or, where there is none, by LIGGGHTS' own. What would
/// make threads meet (contacts stored or printed one by one, heat of walls, energy budgets, rigid
/// bodies, multi-contact laws) is LIGGGHTS' own.
class FixWallGran : public LAMMPS_NS::FixWallGran, public OwnWork {
public:
  FixWallGran(LAMMPS_NS::LAMMPS* lammps, int narg, char** arg);

  void init() override;
  void setup(int vflag) override;
  void pre_neighbor() override;

  bool begin_own_work(int eflag, int vflag) override;
  void own_work(int thread, Range block) override;
  void end_own_work() override;
  [[nodiscard]] bool looks_back() const override;

  /// From here on, until the next init(), contacts with this wall make heat too. Returns what
  /// stands against that with this law, or an empty text.
  [[nodiscard]] std::string set_heat(HeatPort& heat, const ContactHeat& law);
  /// Whether what resists motion there by speed is noted: it makes heat in half a kick, too.
  [[nodiscard]] bool rubs() const { return kernel_suits_ && kernel_->rubs(); }

  /// Those that it has: of the primitive, or of meshes [K].
  [[nodiscard]] std::vector<double> temperatures() const;

protected:
  void post_force_mesh(int vflag) override;

private:
  /// What one contact does to the mesh.
  struct ForceOnMesh {
    bool acts = false;
    int particle, triangle;
    double force[3], to_wall[3], wall_velocity[3]; // N on the particle, m, m/s
  };
  struct Mesh {
    LAMMPS_NS::TriMesh* triangles = nullptr;
    LAMMPS_NS::FixContactHistoryMesh* history = nullptr;
    double*** velocity = nullptr; // of the three corners of each triangle, or null
    int number = 0, wall_type = 1;
    HeatOfWall heat;
    WallPairs pairs;
    bool stands = false;       // in this step: it rests, and only the sums of forces are asked for
    StandingContacts standing; // of rows of pairs
    std::vector<ForceOnMesh> forces; // of each pair, where a module of the mesh sums them
  };

  class Batch;

  [[nodiscard]] const char* reason_for_stock() const;
  [[nodiscard]] bool kernel_suits() const;
  void decide();
  [[nodiscard]] bool is_centred(int particle, double gap, const double* to_wall) const;
  void note_centred(int particle);
  void refuse_centred_on_primitive();
  void refuse_centred(const Mesh* mesh);
  [[nodiscard]] bool all_of_one_type() const;
  [[nodiscard]] HeatOfWall heat_of_wall(LAMMPS_NS::TriMesh* triangles) const;
  void touch_primitive(Range block);
  void touch_primitive(int particle, const double* wall_velocity, Batch& batch);
  [[nodiscard]] Vec3 primitive_velocity(int particle, const double* wall_velocity);
  void leave_primitive(int particle, double gap, const double* to_wall, const double* wall_velocity,
                       double* history);
  void begin_mesh(int number);
  void sum_on_mesh(Mesh& mesh);
  void touch_mesh(Mesh& mesh, Range block);
  void touch_row(Mesh& mesh, std::size_t row, Batch& batch);
  void touch_mesh(const Mesh& mesh, int particle, int triangle, ForceOnMesh* on_mesh, Batch& batch);
  void leave_mesh(const Mesh& mesh, int particle);
  void keep_history(const Mesh& mesh, int particle);
  template <class Evaluate>
  bool add_standing(StandingContacts& standing, std::size_t row, int particle, Evaluate&& evaluate);
  [[nodiscard]] bool is_frozen(int particle) const;
  struct MeshPlace {
    double gap;
    double to_wall[3], weight[3]; // of the corners
    bool within;                  // not on an edge or a corner
  };
  [[nodiscard]] MeshPlace place_on(const Mesh& mesh, int particle, int triangle) const;
  [[nodiscard]] static Vec3 velocity_at(const Mesh& mesh, int triangle, const MeshPlace& place);
  void touch_by_host(const WallTouch& touch, const Mesh* mesh, int triangle, ForceOnMesh* on_mesh);

  GranWords words_;
  std::unique_ptr<WallKernel> kernel_;     // null: there is none for these laws
  const char* reason_for_stock_ = nullptr; // of this run; null: threads may share the work
  bool kernel_suits_ = false;              // of this run
  bool by_kernel_ = false;                 // in this step
  int frozen_group_ = 0;                   // whose forces move nothing
  std::atomic<int> centred_ = -1;          // a particle that has its centre on the wall
  Vec3 centred_at_;
  HeatPort* heat_ = nullptr;        // null: none
  bool makes_heat_ = false;         // in this step
  bool springs_leave_heat_ = false; // likewise, of contacts that end
  HeatOfWall primitive_heat_;       // of this step
  bool primitive_stands_ = false;   // it rests, and particles are frozen
  StandingContacts standing_;       // of those near the primitive
  bool standing_current_ = false;   // for its list
  Particles particles_;
  std::vector<Mesh> meshes_;
};

} // namespace granflux::particle_subset
