// SPDX-FileCopyrightText: 2026 The GranFlux developers
// SPDX-License-Identifier: GPL-2.0-or-later

#include "fix_wall_gran.hpp"

#include <algorithm>
#include <array>
#include <span>
#include <string>

#include <fmt/core.h>

#include <liggghts/atom.h>
#include <liggghts/error.h>

#include <liggghts/fix_contact_history_mesh.h>
#include <liggghts/fix_mesh_surface.h>
#include <liggghts/fix_neighlist_mesh.h>
#include <liggghts/fix_property_atom.h>
#include <liggghts/force.h>
#include <liggghts/granular_wall.h>
#include <liggghts/multi_vector_container.h>
#include <liggghts/neighbor.h>
#include <liggghts/pair_gran.h>
#include <liggghts/primitive_wall.h>
#include <liggghts/properties.h>
#include <liggghts/tri_mesh.h>
#include <liggghts/update.h>

#include "host_material.hpp"
#include "say_once.hpp"
#include "team.hpp"

namespace granflux::particle_subset {

namespace {

using LIGGGHTS::ContactModels::SurfacesIntersectData;

/// FixContactHistoryMesh::keepflag_ is protected: a class derived from it may name it.
struct MeshHistoryAccess : LAMMPS_NS::FixContactHistoryMesh {
  static auto kept() { return &MeshHistoryAccess::keepflag_; }
  static auto intersects() { return &MeshHistoryAccess::intersectflag_; }
};

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

Vec3* rows(double** array) {
  return array ? reinterpret_cast<Vec3*>(array[0]) : nullptr;
}

/// Number by number: a whole one copied soon after it was written would wait for that.
void set_touch(WallTouch& touch, int particle, double gap, const double* to_wall,
               const Vec3& velocity, double* history) {
  touch.particle = particle;
  touch.gap = gap;
  touch.separation = {-to_wall[0], -to_wall[1], -to_wall[2]};
  touch.wall_velocity = velocity;
  touch.history = history;
}

/// The words of the contact model and its options, which stand before and after those of the wall.
std::vector<char*> model_words(int narg, char** arg, int options) {
  constexpr std::array keywords{"model", "tangential", "rolling_friction", "cohesion", "surface"};
  std::vector<char*> words;
  for (int w = 3;
       w + 1 < options && std::ranges::find(keywords, std::string_view(arg[w])) != keywords.end();
       w += 2)
    words.insert(words.end(), {arg[w], arg[w + 1]});
  words.insert(words.end(), arg + options, arg + narg);
  return words;
}

} // namespace

/// Touches of one thread, evaluated some at a time.
class FixWallGran::Batch {
public:
  Batch(FixWallGran& fix, int wall_type, const HeatOfWall& heat)
      : fix_(fix), wall_type_(wall_type), heat_(heat) {}
  ~Batch() { evaluate(); }
  Batch(const Batch&) = delete;
  Batch& operator=(const Batch&) = delete;

  /// Where the next one is written.
  [[nodiscard]] WallTouch& next() { return touch_[count_]; }
  /// What was written there is evaluated.
  void take(ForceOnMesh* on_mesh) {
    on_mesh_[count_] = on_mesh;
    if (++count_ == capacity)
      evaluate();
  }

private:
  static constexpr std::size_t capacity = 64;

  void evaluate() {
    if (count_ == 0) // as ever where LIGGGHTS' own law is at work and there is no kernel
      return;
    const std::span touches(touch_.data(), count_);
    if (fix_.makes_heat_)
      fix_.kernel_->add_with_heat(fix_.particles_, touches, wall_type_, fix_.update->dt, heat_);
    else
      fix_.kernel_->add(fix_.particles_, touches, wall_type_, fix_.update->dt);
    for (std::size_t k = 0; k < count_; ++k) {
      const Vec3& force = touch_[k].force;
      if (fix_.store_force_)
        for (int d = 0; d < 3; ++d)
          fix_.fix_wallforce_->array_atom[touch_[k].particle][d] += force[d];
      if (on_mesh_[k]) {
        on_mesh_[k]->acts = true;
        for (int d = 0; d < 3; ++d)
          on_mesh_[k]->force[d] = force[d];
      }
    }
    count_ = 0;
  }

  FixWallGran& fix_;
  int wall_type_;
  const HeatOfWall& heat_;
  std::size_t count_ = 0;
  std::array<WallTouch, capacity> touch_;
  std::array<ForceOnMesh*, capacity> on_mesh_;
};

FixWallGran::FixWallGran(LAMMPS_NS::LAMMPS* lammps, int narg, char** arg)
    : LAMMPS_NS::FixWallGran(lammps, narg, arg) {
  std::vector<char*> words = model_words(narg, arg, iarg_);
  words_ = read_gran_words(words);
  kernel_ = make_wall_kernel(words_.laws);
}

void FixWallGran::init() {
  LAMMPS_NS::FixWallGran::init();
  heat_ = nullptr;
  if (kernel_suits())
    kernel_->read(HostMaterial(force->registry, words_, "fix wall/gran"),
                  atom->get_properties()->max_type());
}

void FixWallGran::setup(int vflag) {
  decide();
  if (!reason_for_stock_ && meshwall_ != 1)
    refuse_centred_on_primitive();
  LAMMPS_NS::FixWallGran::setup(vflag);
  if (modify->n_fixes_style("granflux/heat") > 0)
    heattransfer_flag_ = false; // it is not LIGGGHTS' own law that conducts
  decide();
}

/// Words are compared once a run.
void FixWallGran::decide() {
  reason_for_stock_ = reason_for_stock();
  kernel_suits_ = kernel_suits();
  const auto* pair = dynamic_cast<const LAMMPS_NS::PairGran*>(force->pair_match("gran", 0));
  frozen_group_ = pair && !heat_ ? pair->freeze_group_bit() : 0;
}

/// Whether a contact has no direction. What is frozen bears any force.
bool FixWallGran::is_centred(int particle, double gap, const double* to_wall) const {
  return gap == -radius_[particle] && to_wall[0] == 0 && to_wall[1] == 0 && to_wall[2] == 0 &&
         !is_frozen(particle);
}

bool FixWallGran::is_frozen(int particle) const {
  return atom->mask[particle] & frozen_group_;
}

/// The first that is found, with its place: it may move on before it is told of.
void FixWallGran::note_centred(int particle) {
  int none = -1;
  if (centred_.compare_exchange_strong(none, particle))
    centred_at_ = rows(atom->x)[particle];
}

/// In a setup it is LIGGGHTS' own loop that meets primitives.
void FixWallGran::refuse_centred_on_primitive() {
  radius_ = atom->radius;
  for (int i = 0; i < atom->nlocal; ++i) {
    double to_wall[3] = {1, 1, 1};
    if ((atom->mask[i] & groupbit) &&
        is_centred(i, primitiveWall_->resolveContact(atom->x[i], radius_[i], to_wall), to_wall))
      note_centred(i);
  }
  refuse_centred(nullptr);
}

/// Stops the run, this rank before the others, where a particle has its centre on the wall. Seldom
/// enough not to ask all ranks in every step.
void FixWallGran::refuse_centred(const Mesh* mesh) {
  if (centred_ < 0)
    return;
  const Vec3& x = centred_at_;
  error->one(FLERR, fmt::format(
                        "particle {} at ({:.10g}, {:.10g}, {:.10g}) m has its centre exactly on {} "
                        "of fix {} wall/gran: their contact has no direction; move or delete it",
                        atom->tag[centred_], x.x, x.y, x.z,
                        mesh ? fmt::format("mesh {}", FixMesh_list_[mesh->number]->id)
                             : std::string("the wall"),
                        id)
                        .c_str());
}

/// False: contacts are evaluated by LIGGGHTS' own law.
bool FixWallGran::kernel_suits() const {
  return kernel_ && words_.malformed.empty() && words_.surface == "default" &&
         words_.unsupported_option().empty() && dnum_ == kernel_->history_size() &&
         !fix_sum_normal_force_ && force->nktv2p == 1 && !force->cg_active();
}

void FixWallGran::pre_neighbor() {
  LAMMPS_NS::FixWallGran::pre_neighbor();
  standing_current_ = false;
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

std::string FixWallGran::set_heat(HeatPort& heat, const ContactHeat& law) {
  if (const char* reason = reason_for_stock())
    return std::string("it is LIGGGHTS' own for ") + reason;
  const bool shape_will_do =
      law.needs_no_force() && law.options().friction == FrictionHeat::off && !law.options().damping;
  if (!kernel_suits() && !shape_will_do)
    return "its contact model has no form by particle subset, from which heat takes forces: use "
           "conduction overlap, stock or off, friction off, damping off";
  if (!kernel_suits() && !all_of_one_type())
    return "its meshes are of several types and its contact model has no form by particle subset";
  heat_ = &heat;
  return {};
}

/// Laws ask the fix for its wall type: it cannot be that of several meshes at once.
bool FixWallGran::all_of_one_type() const {
  for (int mesh = 1; mesh < n_FixMesh_; ++mesh)
    if (FixMesh_list_[mesh]->atomTypeWall() != FixMesh_list_[0]->atomTypeWall())
      return false;
  return true;
}

bool FixWallGran::begin_own_work(int /*eflag*/, int /*vflag*/) {
  if (reason_for_stock_) {
    say_once(*lmp, std::string("fix wall/gran is LIGGGHTS' own for ") + reason_for_stock_);
    return false;
  }
  by_kernel_ = kernel_suits_;
  computeflag_ = shearupdate_ = 1; // a step, not its setup
  addflag_ = 0;                    // not asked for by a compute
  x_ = atom->x;
  f_ = atom->f;
  radius_ = atom->radius;
  cutneighmax_ = neighbor->cutneighmax;
  particles_ = {.owned = atom->nlocal,
                .all = atom->nlocal,
                .position = rows(atom->x),
                .velocity = rows(atom->v),
                .spin = rows(atom->omega),
                .radius = atom->radius,
                .mass = atom->rmass,
                .type = atom->type,
                .tag = atom->tag,
                .groups = atom->mask,
                .alike = {},
                .force = rows(atom->f),
                .torque = rows(atom->torque)};
  if (!by_kernel_ && !all_of_one_type())
    return false;
  makes_heat_ = heat_ && !heat_->heat_of_contacts().rests();
  springs_leave_heat_ = makes_heat_ && by_kernel_ && dnum() > 0 && heat_->parted_heat();
  if (meshwall_ == 1) {
    for (int mesh = 0; mesh < n_FixMesh_; ++mesh)
      begin_mesh(mesh);
    return true;
  }
  if (makes_heat_)
    primitive_heat_ = heat_of_wall(nullptr);
  primitive_stands_ = frozen_group_ && !shear_;
  if (!standing_current_) {
    int* first = nullptr;
    standing_.forget(primitive_stands_ ? std::size_t(primitiveWall_->getNeighbors(first)) : 0);
    standing_current_ = true;
  }
  return true;
}

std::vector<double> FixWallGran::temperatures() const {
  if (meshwall_ != 1)
    return Temp_wall >= 0 ? std::vector<double>{Temp_wall} : std::vector<double>{};
  std::vector<double> found;
  for (int mesh = 0; mesh < n_FixMesh_; ++mesh)
    if (auto* temperature = FixMesh_list_[mesh]
                                ->triMesh()
                                ->prop()
                                .getGlobalProperty<LAMMPS_NS::ScalarContainer<double>>("Temp"))
      found.push_back((*temperature)(0));
  return found;
}

/// Of this moment; of the primitive if there are no triangles.
HeatOfWall FixWallGran::heat_of_wall(LAMMPS_NS::TriMesh* triangles) const {
  HeatOfWall heat{.contacts = heat_->heat_of_contacts(), .temperature = {}};
  if (!triangles) {
    if (Temp_wall >= 0)
      heat.temperature = Temp_wall;
  } else if (auto* temperature =
                 triangles->prop().getGlobalProperty<LAMMPS_NS::ScalarContainer<double>>("Temp")) {
    heat.temperature = (*temperature)(0);
  }
  return heat;
}

void FixWallGran::own_work(int /*thread*/, Range block) {
  if (store_force_)
    for (int i = block.begin; i < block.end; ++i)
      std::fill_n(fix_wallforce_->array_atom[i], 3, 0.0);
  if (meshwall_ == 1)
    for (Mesh& mesh : meshes_)
      touch_mesh(mesh, block);
  else
    touch_primitive(block);
}

void FixWallGran::touch_primitive(Range block) {
  int* first = nullptr;
  const int count = primitiveWall_->getNeighbors(first);
  const std::span<const int> near(first, std::size_t(count)); // ascending
  auto p = std::lower_bound(near.begin(), near.end(), block.begin);
  if (p == near.end() || *p >= block.end)
    return;
  double wall_velocity[3] = {0, 0, 0};
  if (shear_)
    wall_velocity[shearDim_] = vshear_;
  Batch batch(*this, atom_type_wall_, primitive_heat_);
  // Those near a wall lie apart in memory. All that the other parts of a step read is in the cache.
  constexpr std::ptrdiff_t ahead = 16;
  const int frozen = primitive_stands_ ? frozen_group_ : 0;
  const int* const groups = igroup == 0 && !frozen ? nullptr : atom->mask; // 0: all
  const double* const histories = dnum() > 0 ? fix_history_primitive_->array_atom[0] : nullptr;
  for (; p != near.end() && *p < block.end; ++p) {
    if (histories && near.end() - p > ahead)
      __builtin_prefetch(histories + std::ptrdiff_t(dnum()) * p[ahead], 1);
    if (groups && !(groups[*p] & groupbit))
      continue;
    if (frozen && (groups[*p] & frozen))
      add_standing(standing_, std::size_t(p - near.begin()), *p, [&] {
        Batch alone(*this, atom_type_wall_, primitive_heat_);
        touch_primitive(*p, wall_velocity, alone);
      });
    else
      touch_primitive(*p, wall_velocity, batch);
  }
}

/// The contacts of a frozen particle with a wall at rest.
template <class Evaluate>
bool FixWallGran::add_standing(StandingContacts& standing, std::size_t row, int particle,
                               Evaluate&& evaluate) {
  const bool known = standing.add(row, particles_, particle, evaluate);
  if (known && store_force_)
    for (int d = 0; d < 3; ++d)
      fix_wallforce_->array_atom[particle][d] += standing.force(row)[d];
  return known;
}

Vec3 FixWallGran::primitive_velocity(int particle, const double* wall_velocity) {
  double velocity[3] = {wall_velocity[0], wall_velocity[1], wall_velocity[2]};
  if (shear_ && shearAxis_ >= 0) { // a turning cylinder
    double radial[3];
    primitiveWall_->calcRadialDistance(x_[0] + 3 * std::ptrdiff_t(particle), radial);
    LAMMPS_NS::vectorCross3D(shearAxisVec_, radial, velocity);
  }
  return {velocity[0], velocity[1], velocity[2]};
}

void FixWallGran::touch_primitive(int particle, const double* wall_velocity, Batch& batch) {
  // Not by the arrays of rows' addresses, which would come from memory for this alone.
  double* const x = x_[0] + 3 * std::ptrdiff_t(particle);
  double* const history =
      dnum() > 0 ? fix_history_primitive_->array_atom[0] + std::ptrdiff_t(dnum()) * particle
                 : nullptr;
  const double radius = radius_[particle];
  double to_wall[3] = {0, 0, 0};
  const double gap = primitiveWall_->resolveContact(x, radius, to_wall);
  if (gap > cutneighmax_)
    return;
  if (gap > 0) {
    leave_primitive(particle, gap, to_wall, wall_velocity, history);
    return;
  }
  if (is_centred(particle, gap, to_wall)) {
    note_centred(particle);
    return;
  }
  WallTouch& touch = batch.next();
  set_touch(touch, particle, gap, to_wall, primitive_velocity(particle, wall_velocity), history);
  if (by_kernel_)
    batch.take(nullptr);
  else
    touch_by_host(touch, nullptr, 0, nullptr);
  if (makes_heat_ && !by_kernel_)
    primitive_heat_.add(particle, atom->type[particle], atom_type_wall_, radius, -gap, 0, {});
}

/// What a contact that is no longer one leaves behind, if there was one.
void FixWallGran::leave_primitive(int particle, double gap, const double* to_wall,
                                  const double* wall_velocity, double* history) {
  if (std::all_of(history, history + dnum(), [](double h) { return h == 0; }))
    return;
  if (springs_leave_heat_) {
    WallTouch last;
    set_touch(last, particle, gap, to_wall, primitive_velocity(particle, wall_velocity), history);
    primitive_heat_.add_parted(
        particle,
        kernel_->left_at_parting(particles_, last, atom_type_wall_, update->dt) / update->dt);
  }
  std::fill_n(history, dnum(), 0.0);
}

void FixWallGran::begin_mesh(int number) {
  using CornerVelocities = LAMMPS_NS::MultiVectorContainer<double, 3, 3>;
  LAMMPS_NS::FixMeshSurface& fix = *FixMesh_list_[number];
  LAMMPS_NS::TriMesh& triangles = *fix.triMesh();
  meshes_.resize(std::size_t(n_FixMesh_));
  Mesh& mesh = meshes_[std::size_t(number)];
  atom_type_wall_ = mesh.wall_type = fix.atomTypeWall();
  auto* velocities = triangles.prop().getElementProperty<CornerVelocities>("v");
  mesh.triangles = &triangles;
  mesh.history = fix.contactHistory();
  mesh.velocity = velocities ? velocities->begin() : nullptr;
  mesh.number = number;
  if (makes_heat_)
    mesh.heat = heat_of_wall(&triangles);
  if (mesh.history)
    mesh.history->markAllContacts();
  const bool lists_are_new = !mesh.pairs.current;
  if (lists_are_new)
    mesh.pairs.turn_round(triangles.sizeLocal() + triangles.sizeGhost(), atom->nlocal,
                          [lists = fix.meshNeighlist()](int triangle) -> const std::vector<int>& {
                            return lists->get_contact_list(triangle);
                          });
  // Stress, wear and the like are summed over the contacts of a mesh: its style then names them.
  const std::string_view mesh_style = fix.style;
  const bool sums = mesh_style != "mesh/surface" && mesh_style != "mesh/surface/planar";
  mesh.forces.assign(sums ? mesh.pairs.triangle.size() : 0, {});
  mesh.stands = frozen_group_ && shearupdate_ && !sums && !mesh.velocity && !triangles.isMoving();
  const std::size_t rows = mesh.stands ? mesh.pairs.particle.size() : 0;
  if (lists_are_new || mesh.standing.rows() != rows)
    mesh.standing.forget(rows);
}

void FixWallGran::touch_mesh(Mesh& mesh, Range block) {
  Batch batch(*this, mesh.wall_type, mesh.heat);
  const WallPairs& pairs = mesh.pairs;
  const auto first = std::lower_bound(pairs.particle.begin(), pairs.particle.end(), block.begin);
  for (auto row = std::size_t(first - pairs.particle.begin());
       row < pairs.particle.size() && pairs.particle[row] < block.end; ++row) {
    const int particle = pairs.particle[row];
    if (!mesh.stands || !is_frozen(particle))
      touch_row(mesh, row, batch);
    else if (add_standing(mesh.standing, row, particle, [&] {
               Batch alone(*this, mesh.wall_type, mesh.heat);
               touch_row(mesh, row, alone);
             }))
      keep_history(mesh, particle);
  }
  if (!mesh.history)
    return;
  if (springs_leave_heat_)
    for (auto p = first; p != pairs.particle.end() && *p < block.end; ++p)
      leave_mesh(mesh, *p);
  mesh.history->cleanUpContacts(block.begin, block.end);
}

void FixWallGran::touch_row(Mesh& mesh, std::size_t row, Batch& batch) {
  const WallPairs& pairs = mesh.pairs;
  for (auto pair = std::size_t(pairs.begin[row]); pair < std::size_t(pairs.begin[row + 1]); ++pair)
    touch_mesh(mesh, pairs.particle[row], pairs.triangle[pair],
               mesh.forces.empty() ? nullptr : &mesh.forces[std::size_t(pairs.place[pair])], batch);
}

/// The contacts that a particle had in the last step go on.
void FixWallGran::keep_history(const Mesh& mesh, int particle) {
  LAMMPS_NS::FixContactHistoryMesh* const known = mesh.history;
  if (!known)
    return;
  bool* const kept = (known->*MeshHistoryAccess::kept())[particle];
  bool* const intersects = (known->*MeshHistoryAccess::intersects())[particle];
  for (int slot = 0; slot < known->nneighs(particle); ++slot)
    kept[slot] = intersects[slot] = known->get_partner_idTri(particle, slot) >= 0;
}

/// What contacts of a particle that are about to be forgotten leave behind.
void FixWallGran::leave_mesh(const Mesh& mesh, int particle) {
  LAMMPS_NS::FixContactHistoryMesh& known = *mesh.history;
  LAMMPS_NS::TriMesh& triangles = *mesh.triangles;
  const bool* kept = (known.*MeshHistoryAccess::kept())[particle];
  const int slots = known.nneighs(particle);
  const auto triangle_of = [&](int slot) { return known.get_partner_idTri(particle, slot); };
  const auto goes_on_beside = [&](int slot) { // a coplanar triangle has taken its memory over
    for (int other = 0; other < slots; ++other)
      if (triangle_of(other) >= 0 && kept[other] &&
          triangles.areCoplanarNodeNeighs(triangle_of(slot), triangle_of(other)))
        return true;
    return false;
  };
  for (int slot = 0; slot < slots; ++slot) {
    if (triangle_of(slot) < 0 || kept[slot])
      continue;
    double* history = known.contacthistory(particle, slot);
    const int triangle = triangles.map(triangle_of(slot), 0);
    if (triangle < 0 || std::all_of(history, history + dnum(), [](double h) { return h == 0; }) ||
        goes_on_beside(slot))
      continue;
    const MeshPlace place = place_on(mesh, particle, triangle);
    const Vec3 velocity = velocity_at(mesh, triangle, place);
    WallTouch last;
    set_touch(last, particle, place.gap, place.to_wall, velocity, history);
    mesh.heat.add_parted(particle,
                         kernel_->left_at_parting(particles_, last, mesh.wall_type, update->dt) /
                             update->dt);
  }
}

/// The point of a triangle that is nearest to a particle.
FixWallGran::MeshPlace FixWallGran::place_on(const Mesh& mesh, int particle, int triangle) const {
  constexpr int face = 7; // LIGGGHTS' name of the place
  MeshPlace place;
  int part = 0;
  place.gap = mesh.triangles->resolveTriSphereContactBary(
      particle, triangle, radius_[particle], x_[particle], place.to_wall, place.weight, part, true);
  place.within = part == face;
  return place;
}

Vec3 FixWallGran::velocity_at(const Mesh& mesh, int triangle, const MeshPlace& place) {
  Vec3 velocity;
  if (mesh.velocity) {
    double** corner = mesh.velocity[triangle];
    for (int d = 0; d < 3; ++d)
      velocity[d] = place.weight[0] * corner[0][d] + place.weight[1] * corner[1][d] +
                    place.weight[2] * corner[2][d];
  }
  return velocity;
}

void FixWallGran::sum_on_mesh(Mesh& mesh) {
  refuse_centred(&mesh);
  for (ForceOnMesh& on : mesh.forces) // in LIGGGHTS' order: its sums, to the last bit
    if (on.acts)
      FixMesh_list_[mesh.number]->add_particle_contribution(on.particle, on.force, on.to_wall,
                                                            on.triangle, on.wall_velocity);
}

/// Modules of a mesh ask where a force acts and how fast the particle is.
bool FixWallGran::looks_back() const {
  return std::ranges::any_of(meshes_, [](const Mesh& mesh) { return !mesh.forces.empty(); });
}

void FixWallGran::end_own_work() {
  if (meshwall_ != 1)
    refuse_centred(nullptr);
  for (Mesh& mesh : meshes_)
    sum_on_mesh(mesh);
}

/// Where meshes are of different types, and in the setup of a run: one after the other.
void FixWallGran::post_force_mesh(int vflag) {
  by_kernel_ = makes_heat_ = springs_leave_heat_ = false; // in a setup histories stay as they are
  if (addflag_ || reason_for_stock_) { // addflag: asked by a compute, contact by contact
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

void FixWallGran::touch_mesh(const Mesh& mesh, int particle, int triangle, ForceOnMesh* on_mesh,
                             Batch& batch) {
  const MeshPlace place = place_on(mesh, particle, triangle);
  if (place.gap > 0)
    return;
  if (is_centred(particle, place.gap, place.to_wall)) {
    note_centred(particle);
    return;
  }
  double* history = nullptr;
  if (mesh.history && !mesh.history->handleContact(particle, mesh.triangles->id(triangle), history,
                                                   true, place.within))
    return;
  const Vec3 wall_velocity = velocity_at(mesh, triangle, place);
  if (on_mesh) {
    on_mesh->particle = particle;
    on_mesh->triangle = triangle;
    for (int d = 0; d < 3; ++d) {
      on_mesh->to_wall[d] = place.to_wall[d];
      on_mesh->wall_velocity[d] = wall_velocity[d];
    }
  }
  WallTouch& touch = batch.next();
  set_touch(touch, particle, place.gap, place.to_wall, wall_velocity, history);
  if (by_kernel_)
    batch.take(on_mesh);
  else
    touch_by_host(touch, &mesh, triangle, on_mesh);
  if (makes_heat_ && !by_kernel_)
    mesh.heat.add(particle, atom->type[particle], mesh.wall_type, radius_[particle], -place.gap, 0,
                  {});
}

void FixWallGran::touch_by_host(const WallTouch& touch, const Mesh* mesh, int triangle,
                                ForceOnMesh* on_mesh) {
  SurfacesIntersectData contact;
  contact.is_wall = true;
  contact.i = touch.particle;
  contact.radi = radius_[touch.particle];
  contact.contact_history = touch.history;
  contact.deltan = -touch.gap;
  double wall_velocity[3];
  for (int d = 0; d < 3; ++d) {
    contact.delta[d] = touch.separation[d];
    wall_velocity[d] = touch.wall_velocity[d];
  }
  const double* sum = f_[touch.particle];
  const double before[3] = {sum[0], sum[1], sum[2]};
  if (mesh) {
    contact.mesh = mesh->triangles;
    contact.fix_mesh = FixMesh_list_[mesh->number];
    impl->compute_force(this, contact, true, wall_velocity, nullptr, mesh->number, mesh->triangles,
                        triangle);
  } else {
    impl->compute_force(this, contact, true, wall_velocity);
  }
  if (!on_mesh || !contact.has_force_update)
    return;
  on_mesh->acts = true;
  for (int d = 0; d < 3; ++d)
    on_mesh->force[d] = sum[d] - before[d];
}

} // namespace granflux::particle_subset
