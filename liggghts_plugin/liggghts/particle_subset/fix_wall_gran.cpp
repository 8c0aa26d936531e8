// SPDX-FileCopyrightText: 2026 The GranFlux developers
// SPDX-License-Identifier: GPL-2.0-or-later

#include "fix_wall_gran.hpp"

#include <algorithm>
#include <span>
#include <string>

#include <liggghts/atom.h>

#include <liggghts/fix_contact_history_mesh.h>
#include <liggghts/fix_mesh_surface.h>
#include <liggghts/fix_neighlist_mesh.h>
#include <liggghts/fix_property_atom.h>
#include <liggghts/granular_wall.h>
#include <liggghts/multi_vector_container.h>
#include <liggghts/neighbor.h>
#include <liggghts/primitive_wall.h>
#include <liggghts/tri_mesh.h>

#include "say_once.hpp"
#include "team.hpp"

namespace granflux::particle_subset {

namespace {

using LIGGGHTS::ContactModels::SurfacesIntersectData;

/// The laws of which it is known that the contacts of different particles do not meet in them.
bool laws_are_separate(LIGGGHTS::Walls::IGranularWall& wall) {
  using namespace std::string_literals;
  const auto one_of = [&](const std::string& kind, std::initializer_list<const char*> names) {
    return std::any_of(names.begin(), names.end(),
                       [&](const char* name) { return wall.contact_match(kind, name); });
  };
  return one_of("surface"s, {"default"}) &&
         one_of("normal"s, {"hooke", "hooke/stiffness", "hertz", "hertz/stiffness"}) &&
         one_of("tangential"s, {"off", "history", "no_history"}) &&
         one_of("rolling_friction"s, {"off", "cdt", "epsd", "epsd2"}) &&
         one_of("cohesion"s, {"off", "sjkr", "sjkr2"});
}

} // namespace

void FixWallGran::pre_neighbor() {
  LAMMPS_NS::FixWallGran::pre_neighbor();
  for (Mesh& mesh : meshes_)
    mesh.pairs.current = false;
}

/// Null: threads may share the work.
const char* FixWallGran::reason_for_stock() const {
  if (!impl || !atom->sphere_flag || atom->shapetype_flag || !atom->rmass)
    return "particles other than spheres";
  if (fix_rigid_)
    return "rigid bodies";
  if (heattransfer_flag_)
    return "heat of walls";
  if (store_force_contact_ || store_force_contact_stress_ || fix_store_multicontact_data_)
    return "forces stored for each contact";
  if (track_energy_ || impl->get_history_offset("dissipation_force") >= 0)
    return "energy budgets";
  if (neighbor->contactDistanceFactor != 1)
    return "forces at a distance";
  if (!laws_are_separate(*impl))
    return "this contact model";
  return nullptr;
}

/// Laws ask the fix for its wall type: it cannot be that of several meshes at once.
bool FixWallGran::all_of_one_type() const {
  for (int mesh = 1; mesh < n_FixMesh_; ++mesh)
    if (FixMesh_list_[mesh]->atomTypeWall() != FixMesh_list_[0]->atomTypeWall())
      return false;
  return true;
}

bool FixWallGran::begin_own_work(int /*eflag*/, int /*vflag*/) {
  if (const char* reason = reason_for_stock()) {
    say_once(*lmp, std::string("fix wall/gran is LIGGGHTS' own for ") + reason);
    return false;
  }
  if (!all_of_one_type())
    return false;
  computeflag_ = shearupdate_ = 1; // a step, not its setup
  addflag_ = 0;                    // not asked for by a compute
  x_ = atom->x;
  f_ = atom->f;
  radius_ = atom->radius;
  cutneighmax_ = neighbor->cutneighmax;
  if (meshwall_ == 1) {
    for (int mesh = 0; mesh < n_FixMesh_; ++mesh)
      begin_mesh(mesh);
  }
  return true;
}

void FixWallGran::own_work(int /*thread*/, Range own) {
  if (store_force_)
    for (int i = own.begin; i < own.end; ++i)
      std::fill_n(fix_wallforce_->array_atom[i], 3, 0.0);
  if (meshwall_ == 1)
    for (Mesh& mesh : meshes_)
      touch_mesh(mesh, own);
  else
    touch_primitive(own);
}

void FixWallGran::touch_primitive(Range own) {
  double wall_velocity[3] = {0, 0, 0};
  if (shear_)
    wall_velocity[shearDim_] = vshear_;
  int* first = nullptr;
  const int count = primitiveWall_->getNeighbors(first);
  const std::span<const int> near(first, std::size_t(count)); // ascending
  for (auto p = std::lower_bound(near.begin(), near.end(), own.begin);
       p != near.end() && *p < own.end; ++p)
    if (atom->mask[*p] & groupbit)
      touch_primitive(*p, wall_velocity);
}

void FixWallGran::touch_primitive(int particle, const double* wall_velocity) {
  double* history = dnum() > 0 ? fix_history_primitive_->array_atom[particle] : nullptr;
  SurfacesIntersectData contact;
  contact.radi = radius_[particle];
  double to_wall[3] = {0, 0, 0};
  const double gap = primitiveWall_->resolveContact(x_[particle], contact.radi, to_wall);
  if (gap > cutneighmax_)
    return;
  if (gap > 0) {
    std::fill_n(history, dnum(), 0.0);
    return;
  }
  double velocity[3] = {wall_velocity[0], wall_velocity[1], wall_velocity[2]};
  if (shear_ && shearAxis_ >= 0) { // a turning cylinder
    double radial[3];
    primitiveWall_->calcRadialDistance(x_[particle], radial);
    LAMMPS_NS::vectorCross3D(shearAxisVec_, radial, velocity);
  }
  contact.is_wall = true;
  contact.i = particle;
  contact.contact_history = history;
  contact.deltan = -gap;
  for (int d = 0; d < 3; ++d)
    contact.delta[d] = -to_wall[d];
  impl->compute_force(this, contact, true, velocity);
}

void FixWallGran::begin_mesh(int number) {
  using CornerVelocities = LAMMPS_NS::MultiVectorContainer<double, 3, 3>;
  LAMMPS_NS::FixMeshSurface& fix = *FixMesh_list_[number];
  LAMMPS_NS::TriMesh& triangles = *fix.triMesh();
  meshes_.resize(std::size_t(n_FixMesh_));
  Mesh& mesh = meshes_[std::size_t(number)];
  atom_type_wall_ = fix.atomTypeWall();
  auto* velocities = triangles.prop().getElementProperty<CornerVelocities>("v");
  mesh.triangles = &triangles;
  mesh.history = fix.contactHistory();
  mesh.velocity = velocities ? velocities->begin() : nullptr;
  mesh.number = number;
  if (mesh.history)
    mesh.history->markAllContacts();
  if (!mesh.pairs.current)
    mesh.pairs.turn_round(triangles.sizeLocal() + triangles.sizeGhost(), atom->nlocal,
                          [lists = fix.meshNeighlist()](int triangle) -> const std::vector<int>& {
                            return lists->get_contact_list(triangle);
                          });
  // Stress, wear and the like are summed over the contacts of a mesh: its style then names them.
  const std::string_view mesh_style = fix.style;
  const bool sums = mesh_style != "mesh/surface" && mesh_style != "mesh/surface/planar";
  mesh.forces.assign(sums ? mesh.pairs.triangle.size() : 0, {});
}

void FixWallGran::touch_mesh(Mesh& mesh, Range own) {
  const WallPairs& pairs = mesh.pairs;
  const auto first = std::lower_bound(pairs.particle.begin(), pairs.particle.end(), own.begin);
  for (auto row = std::size_t(first - pairs.particle.begin());
       row < pairs.particle.size() && pairs.particle[row] < own.end; ++row)
    for (auto pair = std::size_t(pairs.begin[row]); pair < std::size_t(pairs.begin[row + 1]);
         ++pair)
      touch_mesh(mesh, pairs.particle[row], pairs.triangle[pair],
                 mesh.forces.empty() ? nullptr : &mesh.forces[std::size_t(pairs.place[pair])]);
  if (mesh.history)
    mesh.history->cleanUpContacts(own.begin, own.end);
}

void FixWallGran::sum_on_mesh(Mesh& mesh) {
  for (ForceOnMesh& on : mesh.forces) // in LIGGGHTS' order: its sums, to the last bit
    if (on.acts)
      FixMesh_list_[mesh.number]->add_particle_contribution(on.particle, on.force, on.to_wall,
                                                            on.triangle, on.wall_velocity);
}

void FixWallGran::end_own_work() {
  for (Mesh& mesh : meshes_)
    sum_on_mesh(mesh);
}

/// Where meshes are of different types, and in the setup of a run: one after the other.
void FixWallGran::post_force_mesh(int vflag) {
  if (addflag_ || reason_for_stock()) { // addflag: asked by a compute, contact by contact
    LAMMPS_NS::FixWallGran::post_force_mesh(vflag);
    return;
  }
  for (int number = 0; number < n_FixMesh_; ++number) {
    begin_mesh(number);
    Mesh& mesh = meshes_[std::size_t(number)];
    for_each_subset(atom->nlocal, [&](Range range) { touch_mesh(mesh, range); });
    sum_on_mesh(mesh);
  }
}

void FixWallGran::touch_mesh(const Mesh& mesh, int particle, int triangle, ForceOnMesh* on_mesh) {
  constexpr int face = 7; // place of the nearest point: within the triangle
  SurfacesIntersectData contact;
  contact.radi = radius_[particle];
  double to_wall[3], weight[3];
  int place = 0;
  const double gap = mesh.triangles->resolveTriSphereContactBary(
      particle, triangle, contact.radi, x_[particle], to_wall, weight, place, true);
  if (gap > 0)
    return;
  if (mesh.history && !mesh.history->handleContact(particle, mesh.triangles->id(triangle),
                                                   contact.contact_history, true, place == face))
    return;
  double wall_velocity[3] = {0, 0, 0};
  if (mesh.velocity) {
    double** corner = mesh.velocity[triangle];
    for (int d = 0; d < 3; ++d)
      wall_velocity[d] =
          weight[0] * corner[0][d] + weight[1] * corner[1][d] + weight[2] * corner[2][d];
  }
  contact.is_wall = true;
  contact.i = particle;
  contact.mesh = mesh.triangles;
  contact.fix_mesh = FixMesh_list_[mesh.number];
  contact.deltan = -gap;
  for (int d = 0; d < 3; ++d)
    contact.delta[d] = -to_wall[d];
  double* sum = f_[particle];
  const double before[3] = {sum[0], sum[1], sum[2]};
  impl->compute_force(this, contact, true, wall_velocity, nullptr, mesh.number, mesh.triangles,
                      triangle);
  if (!on_mesh || !contact.has_force_update)
    return;
  on_mesh->acts = true;
  on_mesh->particle = particle;
  on_mesh->triangle = triangle;
  for (int d = 0; d < 3; ++d) {
    on_mesh->force[d] = sum[d] - before[d];
    on_mesh->to_wall[d] = to_wall[d];
    on_mesh->wall_velocity[d] = wall_velocity[d];
  }
}

} // namespace granflux::particle_subset
